// Directions in 32 bits: the sphere as an octahedron, unfolded to a square. ("A Survey of Efficient
// Representations for Independent Unit Vectors", Cigolle and others, JCGT 3:2, 2014.) Directions
// along the axes come back exactly.

uint folded(vec3 direction) {
    vec3 size = abs(direction);
    vec2 square = direction.xy / (size.x + size.y + size.z);
    if (direction.z < 0.0) {
        square = (1.0 - abs(square.yx)) * vec2(
            square.x >= 0.0 ? 1.0 : -1.0, square.y >= 0.0 ? 1.0 : -1.0);
    }
    ivec2 whole = ivec2(round(square * 32767.0));
    return (uint(whole.x) & 0xffffu) | (uint(whole.y) << 16);
}

vec2 in_square(uint direction) {
    return vec2(int(direction << 16) >> 16, int(direction) >> 16) / 32767.0;
}

vec3 on_sphere(vec2 square) {
    vec3 direction = vec3(square, 1.0 - abs(square.x) - abs(square.y));
    float below = max(-direction.z, 0.0);
    direction.xy += vec2(
        direction.x >= 0.0 ? -below : below, direction.y >= 0.0 ? -below : below);
    return normalize(direction);
}
