// Surfaces, in the draft's axes already: there is no model matrix.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint row;
layout(location = 3) in vec2 coordinates;

uniform mat4 to_clip;

out vec3 facing;
flat out uint of;
#ifdef TEXTURE
out vec2 place_in_texture;
#endif
#ifdef CLEAR
out vec3 at;
#endif

void main() {
    facing = normal;
    of = row;
#ifdef TEXTURE
    place_in_texture = coordinates;
#endif
#ifdef CLEAR
    at = position;
#endif
    gl_Position = to_clip * vec4(position, 1.0);
}
