// Translucent surfaces: each adds itself to the list of its pixel.

in vec3 facing;
in vec3 at;
flat in uint of;
#ifdef TEXTURE
in vec2 place_in_texture;
uniform sampler2D grain;
#endif

uniform sampler2DMS depths;       // of what is opaque
layout(r32ui, binding = 0) uniform uimage2D heads;

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    uint samples = uint(gl_SampleMaskIn[0]) & ALL;
    for (int k = 0; k < SAMPLES; k++) {
        if (texelFetch(depths, place, k).r <= gl_FragCoord.z) samples &= ~(1u << k);
    }
#ifdef HALOS
    samples &= uint(outside_of_halos(of, texelFetch(table, 3 * int(of) + 2).y));
#endif
    if (samples == 0u) discard;
#ifdef TEXTURE
    vec3 colors = texture(grain, place_in_texture).rgb;
#else
    vec3 colors = vec3(1.0);
#endif
    vec3 n = normalize(facing);
    float fallen;
    vec4 color = lit(at, n, of, colors, fallen);
    // Thicker along its rim; and what is mirrored is as bright as on anything else.
    vec3 v = normalize(eye.xyz - eye.w * at);
    float slant = 1.0 - clamp(dot(n, v), 0.0, 1.0);
    float opacity = texelFetch(table, 3 * int(of)).a;
    opacity += (1.0 - opacity) * 0.55 * slant * slant * slant;
    opacity = mix(clamp(color.a, 0.0, 1.0), 1.0, opacity);
    uint number = atomicAdd(count, 1u);
    if (number < most) {
        uint next = imageAtomicExchange(heads, place, number + 1u);
        nodes[number] = uvec4(
            next,
            floatBitsToUint(gl_FragCoord.z),
            packUnorm4x8(vec4(color.rgb * opacity, opacity)),
            (of << SAMPLE_BITS) | samples);
    }
}
