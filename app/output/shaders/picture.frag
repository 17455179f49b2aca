// The picture, from what is seen at each sample. Samples of one surface are shaded once: so it
// costs little more than one sample for each pixel, and is as smooth as all of them.

uniform usampler2DMS surfaces;    // normal and row
uniform sampler2DMS depths;
#ifdef ALBEDOS
uniform sampler2DMS albedos;
#endif
uniform int rows;                 // of the picture: the first is the highest
uniform mat4 to_world;            // from places in the window
uniform vec4 ground;              // (a, b, c): its depth is (a, b, c)·(x, y, 1); 1 if it is seen
uniform float unshaded;           // luminance on the ground where no shadow falls
uniform vec4 background;          // sRGB multiplied by opacity, and opacity

out vec4 seen;

const vec3 SHADE = vec3(0.085, 0.095, 0.13);  // sRGB: what a shadow on the ground turns into
const float SMOOTH = 0.08;        // how much normals may differ that are shaded as one

uvec2 surface_at(ivec2 place, int k) {
    return texelFetch(surfaces, place, k).rg;
}

bool is_alike(uvec2 one, uvec2 other) {
    vec2 apart = abs(in_square(one.x) - in_square(other.x));
    return one.y == other.y && max(apart.x, apart.y) < SMOOTH;
}

vec4 shaded(ivec2 place, int k, uvec2 surface) {
    bool is_ground = surface.y == 0u;
    vec2 middle = vec2(place) + 0.5;
    float depth = is_ground
        ? dot(ground.xyz, vec3(middle, 1.0)) : texelFetch(depths, place, k).r;
    vec4 found = to_world * vec4(middle, depth, 1.0);
    vec3 at = found.xyz / found.w;
    vec3 n = is_ground ? vec3(0.0, 0.0, 1.0) : on_sphere(in_square(surface.x));
#ifdef ALBEDOS
    vec3 grain = texelFetch(albedos, place, k).rgb;
#else
    vec3 grain = vec3(1.0);
#endif
    float fallen;
    vec3 color = lit(at, n, surface.y, grain, fallen).rgb;
    float shade = 1.0 - sqrt(clamp(fallen / unshaded, 0.0, 1.0));
    shade = found.w > 0.0 ? shade * ground.w : 0.0;
    vec4 below = vec4(SHADE * shade, shade) + background * (1.0 - shade);
    return is_ground ? below : vec4(color, 1.0);
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.x, rows - 1 - int(gl_FragCoord.y));
    uvec2 surface[SAMPLES];
    for (int k = 0; k < SAMPLES; k++) surface[k] = surface_at(place, k);
    vec4 sum = vec4(0.0);
    int left = (1 << SAMPLES) - 1;
    do {
        int k = findLSB(left);
        uvec2 mine = surface_at(place, k);
        int alike = 1 << k;
        for (int other = 0; other < SAMPLES; other++) {
            if (is_alike(surface[other], mine)) alike |= 1 << other;
        }
        alike &= left;
        sum += shaded(place, k, mine) * float(bitCount(alike));
        left &= ~alike;
    } while (left != 0);
    seen = sum / float(SAMPLES);
#ifdef CLEARS
    seen = behind_glass(place, seen);
#endif
}
