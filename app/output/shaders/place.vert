// Where vertices are, for depth alone. They are in the draft's axes: there is no model matrix.

layout(location = 0) in vec3 position;
layout(location = 2) in uint row;

uniform mat4 to_clip;

#ifdef SIEVE
uniform samplerBuffer table;
flat out float opacity;
#endif

void main() {
#ifdef SIEVE
    opacity = texelFetch(table, 3 * int(row)).a;
#endif
    gl_Position = to_clip * vec4(position, 1.0);
}
