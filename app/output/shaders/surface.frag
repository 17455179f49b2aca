#version 330 core
// Surfaces in the light of a few suns and a sky, and the ground as nothing but its shadows.
// Colours are linear until the last line; what leaves is sRGB, multiplied by opacity.

const float PI = 3.14159265;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);
const vec3 SHADE = vec3(0.085, 0.095, 0.13);  // sRGB: what a shadow on the ground turns into

in vec3 at;
in vec3 facing;
in vec2 metallic_roughness;
in vec4 base_color;
in vec3 sun_place;
in vec2 sky_place;

out vec4 seen;

uniform vec4 eye;                 // (position, 1) in perspective, (direction, 0) without
uniform vec3 toward[LIGHTS];
uniform vec3 radiance[LIGHTS];    // the first is the sun that casts shadows
uniform vec3 sky;
uniform vec3 earth;
uniform sampler2DShadow sun_map;
uniform sampler2D sky_map;        // heights of the items, blurred a little and a lot
uniform float reach;              // how far the lot is

// Share of the sun that arrives: the mean over a window of 3 by 3 texels that slides smoothly.
// Four bilinear taps weigh the 4 by 4 texels that it touches exactly. A window of three also
// evens out the pattern by which translucent things cast lighter shadows.
float sunlight() {
#ifdef SUN_CASTS
    vec2 size = vec2(textureSize(sun_map, 0));
    vec2 window = sun_place.xy * size - 1.5;
    vec2 part = fract(window);
    vec2 first = (window - part + 0.5 + 1.0 / (2.0 - part)) / size;
    vec2 second = (window - part + 2.5 + part / (1.0 + part)) / size;
    vec4 lit = vec4(
        texture(sun_map, vec3(first, sun_place.z)),
        texture(sun_map, vec3(second.x, first.y, sun_place.z)),
        texture(sun_map, vec3(first.x, second.y, sun_place.z)),
        texture(sun_map, vec3(second, sun_place.z)));
    vec2 row = vec2(2.0 - part.x, 1.0 + part.x);
    return dot(lit, vec4(row * (2.0 - part.y), row * (1.0 + part.y))) / 9.0;
#else
    return 1.0;
#endif
}

// Share of the sky that is open: by how deep this lies below its surroundings, near and wide.
float openness() {
#ifdef CONTACTS
    vec2 buried = max(texture(sky_map, sky_place).rg - at.z, 0.0) / reach;
    return 1.0 / (1.0 + 0.35 * min(buried.r, 2.0) + 0.7 * min(buried.g, 2.0));
#else
    return 1.0;
#endif
}

#ifndef CATCHER

// Reflection of one sun: GGX with visibility and Fresnel folded into one fraction, after
// "Optimizing PBR for Mobile" (Zioma, SIGGRAPH 2015, course on mobile graphics).
vec3 gloss(vec3 n, vec3 v, vec3 l, vec3 f0, float alpha) {
    vec3 h = normalize(l + v);
    float nh = max(dot(n, h), 0.0);
    float lh = max(dot(l, h), 0.0);
    float spread = nh * nh * (alpha * alpha - 1.0) + 1.0001;
    return f0 * (alpha * alpha / (spread * spread * max(0.1, lh * lh) * (4.0 * alpha + 2.0)));
}

// Colours up to 0.8 stay as they are; above, the brightest channel nears 1 and never passes it.
vec3 shoulder(vec3 color) {
    float top = max(color.r, max(color.g, color.b));
    float over = max(top - 0.8, 0.0);
    return color * ((top - over + over / (1.0 + 5.0 * over)) / max(top, 1e-6));
}

vec3 to_srgb(vec3 color) {
    return mix(12.92 * color, 1.055 * pow(max(color, 1e-6), vec3(1.0 / 2.4)) - 0.055,
        step(0.0031308, color));
}

#endif

void main() {
    vec3 n = normalize(facing);
    float sun = sunlight();
    float open = openness();
    vec3 ambient = mix(earth, sky, 0.5 + 0.5 * n.z);
    vec3 falling = ambient * open;

#ifdef CATCHER
    vec3 unshaded = ambient;
    for (int i = 0; i < LIGHTS; i++) {
        vec3 light = radiance[i] * max(dot(n, toward[i]), 0.0);
        unshaded += light;
        falling += light * (i == 0 ? sun : open);
    }
    float shade = 1.0 - pow(dot(falling, LUMINANCE) / dot(unshaded, LUMINANCE), 1.0 / 2.2);
    seen = vec4(SHADE * shade, shade);
#else
    vec3 v = normalize(eye.xyz - eye.w * at);
    float nv = max(dot(n, v), 1e-3);
    float metallic = metallic_roughness.x;
    float roughness = clamp(metallic_roughness.y, 0.08, 1.0);
    // Paper does not shine: at 0.04 throughout, its colours would turn to pastels.
    vec3 f0 = mix(vec3(0.04 * (1.0 - 0.9 * roughness)), base_color.rgb, metallic);
    vec3 mirrored = vec3(0.0);
    for (int i = 0; i < LIGHTS; i++) {
        vec3 light = radiance[i] * ((i == 0 ? sun : open) * max(dot(n, toward[i]), 0.0));
        falling += light;
        mirrored += light * gloss(n, v, toward[i], f0, roughness * roughness);
    }
    // The surroundings in the surface: a bright sky with a soft horizon.
    float up = reflect(-v, n).z;
    float blur = 0.15 + 0.85 * roughness;
    vec3 around = mix(earth, 1.3 * sky, smoothstep(-blur, blur, up));
    float edge = (1.0 - nv) * (1.0 - nv);
    float sheen = (1.0 - roughness) * (1.0 - roughness);
    vec3 grazing = f0 + max(vec3(sheen) - f0, 0.0) * (edge * edge * (1.0 - nv));
    mirrored += around * open * grazing;
    vec3 color = base_color.rgb * (1.0 - metallic) * falling + mirrored;
    // What is mirrored in glass is as bright as in anything else.
    float glint = clamp(max(mirrored.r, max(mirrored.g, mirrored.b)), 0.0, 1.0);
    float opacity = mix(glint, 1.0, base_color.a);
    seen = vec4(to_srgb(shoulder(color)) * opacity, opacity);
#endif
}
