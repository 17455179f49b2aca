// Surfaces in the light of a few suns and a sky. Colours are linear, until they are seen.

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

uniform vec4 eye;                 // (position, 1) in perspective, (direction, 0) without
uniform vec3 toward[LIGHTS];
uniform vec3 radiance[LIGHTS];    // the first is the sun that casts shadows
uniform vec3 sky;
uniform vec3 earth;
uniform sampler2DShadow sun_map;
uniform mat4 sun_matrix;          // to that map, each coordinate from 0 to 1
uniform float sun_texel;          // the side of one of its texels in the scene
uniform sampler2D sky_map;        // heights of the items, blurred a little and a lot
uniform mat4 sky_matrix;
uniform float reach;              // how far the lot is
uniform samplerBuffer table;

// Share of the sun that arrives: the mean over a window of 3 by 3 texels that slides smoothly.
// Four bilinear taps weigh the 4 by 4 texels that it touches exactly. A window of three also
// evens out the pattern by which translucent things cast lighter shadows.
float sunlight(vec3 at, vec3 n) {
#ifdef SUN_CASTS
    // Off the surface by as much as the filter is wide: more where the sun grazes it.
    float cosine = dot(n, toward[0]);
    float lift = sun_texel * (0.5 + 2.5 * sqrt(max(0.0, 1.0 - cosine * cosine)));
    vec3 place = (sun_matrix * vec4(at + lift * n, 1.0)).xyz;
    place.z = min(place.z, 1.0);
    vec2 size = vec2(textureSize(sun_map, 0));
    vec2 window = place.xy * size - 1.5;
    vec2 part = fract(window);
    vec2 first = (window - part + 0.5 + 1.0 / (2.0 - part)) / size;
    vec2 second = (window - part + 2.5 + part / (1.0 + part)) / size;
    vec4 lit = vec4(
        texture(sun_map, vec3(first, place.z)),
        texture(sun_map, vec3(second.x, first.y, place.z)),
        texture(sun_map, vec3(first.x, second.y, place.z)),
        texture(sun_map, vec3(second, place.z)));
    vec2 row = vec2(2.0 - part.x, 1.0 + part.x);
    return dot(lit, vec4(row * (2.0 - part.y), row * (1.0 + part.y))) / 9.0;
#else
    return 1.0;
#endif
}

// Share of the sky that is open: by how deep this lies below its surroundings, near and wide.
float openness(vec3 at, vec3 n) {
#ifdef CONTACTS
    // What stands beside a wall darkens it, not the item that it belongs to.
    vec2 place = (sky_matrix * vec4(at + 0.7 * reach * n, 1.0)).xy;
    vec2 buried = max(texture(sky_map, place).rg - at.z, 0.0) / reach;
    return 1.0 / (1.0 + 0.35 * min(buried.r, 2.0) + 0.7 * min(buried.g, 2.0));
#else
    return 1.0;
#endif
}

// Reflection of one sun: GGX with visibility and Fresnel folded into one fraction, after
// "Optimizing PBR for Mobile" (Zioma, SIGGRAPH 2015, course on mobile graphics). ``nh2`` and
// ``lh2`` are squares of cosines toward the half vector.
float gloss(float nh2, float lh2, float alpha2, float rough) {
    float spread = nh2 * (alpha2 - 1.0) + 1.0001;
    return alpha2 / (spread * spread * max(0.1, lh2) * rough);
}

float pow4(float x) {
    return x * x * x * x;
}

// Colours up to 0.8 stay as they are; above, the brightest channel nears 1 and never passes it.
vec3 shoulder(vec3 color) {
    float top = max(color.r, max(color.g, color.b));
    float over = max(top - 0.8, 0.0);
    return color * ((top - over + over / (1.0 + 5.0 * over)) / max(top, 1e-6));
}

// Within a thousandth of the curve in the standard, by roots alone, which are quick.
vec3 to_srgb(vec3 color) {
    vec3 root = sqrt(color);
    vec3 fourth = sqrt(root);
    vec3 upper = 0.662002687 * root + 0.684122060 * fourth - 0.323583601 * sqrt(fourth)
        - 0.0225411470 * color;
    return mix(12.92 * color, upper, step(0.0031308, color));
}

#ifdef METALS
// What a metal sees in a studio: paper below, a dark horizon, and soft boxes where the lights are.
vec3 studio(vec3 way, float blur) {
    float up = way.z;
    vec3 seen = mix(earth * 1.9, sky * 0.25, smoothstep(-0.35 - blur, 0.12 + blur, up));
    seen += sky * (1.1 * smoothstep(0.15 - blur, 0.95 + 0.3 * blur, up));
    for (int i = 0; i < LIGHTS; i++) {
        float box = smoothstep(0.72 - 0.8 * blur, 0.86 + 0.3 * blur, dot(way, toward[i]));
        seen += radiance[i] * (0.75 * box);
    }
    return seen;
}
#endif

// sRGB, and the share of it that is reflected and so is as bright on glass as on anything.
// ``fallen`` is the luminance of the light that falls here.
vec4 lit(vec3 at, vec3 n, uint row, vec3 grain, out float fallen) {
    float sun = sunlight(at, n);
    float open = openness(at, n);
    vec3 base = texelFetch(table, 3 * int(row)).rgb * grain;
    vec4 kind = texelFetch(table, 3 * int(row) + 1);
    float metallic = kind.x;
    float roughness = clamp(kind.y, 0.08, 1.0);
    vec3 v = normalize(eye.xyz - eye.w * at);
    float nv = max(dot(n, v), 1e-3);
    // Paper does not shine: at 0.04 throughout, its colours would turn to pastels.
    vec3 f0 = mix(vec3(0.04 * (1.0 - 0.9 * roughness)), base, metallic);
    vec3 falling = mix(earth, sky, 0.5 + 0.5 * n.z) * open;
    vec3 mirrored = vec3(0.0);
#ifdef COATS
    float coat_roughness = clamp(kind.w, 0.08, 1.0);
    vec3 coated = vec3(0.0);
    float coat_alpha2 = pow4(coat_roughness);
    float coat_rough = 4.0 * coat_roughness * coat_roughness + 2.0;
#endif
    float alpha2 = pow4(roughness);
    float rough = 4.0 * roughness * roughness + 2.0;
    for (int i = 0; i < LIGHTS; i++) {
        float nl = max(dot(n, toward[i]), 0.0);
        float lv = 1.0 + dot(toward[i], v);
        float half_cosine = max(nl + nv, 0.0);
        // The half vector is (l + v) / sqrt(2 + 2 l·v): it need not be known.
        float nh2 = half_cosine * half_cosine / (2.0 * lv + 1e-6);
        float lh2 = 0.5 * lv;
        vec3 light = radiance[i] * ((i == 0 ? sun : open) * nl);
        falling += light;
        mirrored += light * gloss(nh2, lh2, alpha2, rough);
#ifdef COATS
        coated += light * gloss(nh2, lh2, coat_alpha2, coat_rough);
#endif
    }
    fallen = dot(falling, LUMINANCE);
    mirrored *= f0;
    // The surroundings in the surface: a bright sky with a soft horizon.
    vec3 way = reflect(-v, n);
    float blur = 0.15 + 0.85 * roughness;
    vec3 around = mix(earth, 1.3 * sky, smoothstep(-blur, blur, way.z));
#ifdef METALS
    around = mix(around, studio(way, roughness), metallic);
#endif
    float edge = (1.0 - nv) * (1.0 - nv);
    edge *= edge * (1.0 - nv);
    float sheen = (1.0 - roughness) * (1.0 - roughness);
    mirrored += around * open * (f0 + max(vec3(sheen) - f0, 0.0) * edge);
    vec3 color = base * (1.0 - metallic) * falling + mirrored;
#ifdef COATS
    float share = kind.z * (0.04 + 0.96 * edge);
    float coat_blur = 0.15 + 0.85 * coat_roughness;
    vec3 above = mix(earth, 1.3 * sky, smoothstep(-coat_blur, coat_blur, way.z));
    color = color * (1.0 - share) + above * open * share + coated * (0.04 * kind.z);
#endif
    color = shoulder(color);
#ifdef PLAIN
    bool is_lit = texelFetch(table, 3 * int(row) + 2).z > 0.5;
    if (!is_lit) return vec4(to_srgb(base), 0.0);
#endif
    return vec4(to_srgb(color), max(mirrored.r, max(mirrored.g, mirrored.b)));
}
