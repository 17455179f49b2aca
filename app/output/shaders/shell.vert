// Tubes that are thicker by the gap that is wanted in what passes behind them.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint row;

uniform mat4 to_clip;
uniform samplerBuffer table;
uniform float pixel;          // the side of one in clip coordinates

flat out uint of;

const float THINNEST = 1.8;  // gap in pixels

void main() {
    float width = texelFetch(table, 3 * int(row) + 2).x;
    of = width > 0.0 ? row : 0u;
    if (width > 0.0) {
        width = max(width, THINNEST * pixel * (to_clip * vec4(position, 1.0)).w);
    }
    gl_Position = to_clip * vec4(position + width * normal, 1.0);
}
