// What is seen at each sample, to be shaded later: the normal, and the row of the table.

in vec3 facing;
flat in uint of;
#ifdef TEXTURE
in vec2 place_in_texture;
uniform sampler2D grain;
#endif
#ifdef HALOS
uniform samplerBuffer table;
#endif

layout(location = 0) out uvec2 surface;
#ifdef ALBEDOS
layout(location = 1) out vec4 albedo;
#endif

void main() {
#ifdef HALOS
    gl_SampleMask[0] = outside_of_halos(of, texelFetch(table, 3 * int(of) + 2).y);
#endif
    surface = uvec2(folded(facing), of);
#ifdef ALBEDOS
#ifdef TEXTURE
    albedo = texture(grain, place_in_texture);
#else
    albedo = vec4(1.0);
#endif
#endif
}
