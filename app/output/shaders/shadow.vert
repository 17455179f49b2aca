#version 330 core
// What is between a light and the scene.

layout(location = 0) in vec3 position;
layout(location = 3) in vec4 color;

uniform mat4 P;

out float opacity;

void main() {
    opacity = color.a;
    gl_Position = P * vec4(position, 1.0);
}
