#version 330 core
// Vertices are in the draft's axes already: there is no model matrix.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 surface;
layout(location = 3) in vec4 color;

uniform mat4 V;
uniform mat4 P;
uniform vec3 toward[LIGHTS];
uniform mat4 sun_matrix;      // to the map of the sun, each coordinate from 0 to 1
uniform float sun_texel;      // the side of one of its texels in the scene
uniform mat4 sky_matrix;
uniform float reach;          // how far an item darkens what is beside it

out vec3 at;
out vec3 facing;
out vec2 metallic_roughness;
out vec4 base_color;
out vec3 sun_place;
out vec2 sky_place;

void main() {
    at = position;
    facing = normal;
    metallic_roughness = surface;
    base_color = color;
    // Off the surface by as much as the filter is wide: more where the sun grazes it.
    float cosine = dot(normal, toward[0]);
    float lift = sun_texel * (0.5 + 2.5 * sqrt(max(0.0, 1.0 - cosine * cosine)));
    sun_place = (sun_matrix * vec4(position + lift * normal, 1.0)).xyz;
    // What stands beside a wall darkens it, not the item that it belongs to.
    sky_place = (sky_matrix * vec4(position + 0.7 * reach * normal, 1.0)).xy;
    gl_Position = P * (V * vec4(position, 1.0));
}
