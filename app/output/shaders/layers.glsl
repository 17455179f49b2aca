// Layers of what is translucent, from far to near. Of one thing only the nearest is seen, so that
// where tubes of one hyperedge meet nothing shows that is inside of another.

uniform usampler2D first_nodes;

bool is_before(float depth, uint number, float other_depth, uint other) {
    return depth < other_depth || (depth == other_depth && number < other);
}

vec4 behind_glass(ivec2 place, vec4 color) {
    uint first = texelFetch(first_nodes, place, 0).r;
    float last_depth = 2.0;
    uint last = 0u;
    while (first != 0u) {
        float depth = -1.0;
        uint found = 0u;
        for (uint n = first; n != 0u; n = nodes[n - 1u].x) {
            float here = uintBitsToFloat(nodes[n - 1u].y);
            if (is_before(here, n, last_depth, last) && !is_before(here, n, depth, found)) {
                depth = here;
                found = n;
            }
        }
        if (found == 0u) break;
        uvec4 node = nodes[found - 1u];
        uint samples = node.w & ALL;
        for (uint n = first; n != 0u; n = nodes[n - 1u].x) {
            uvec4 other = nodes[n - 1u];
            bool is_same = other.w >> SAMPLE_BITS == node.w >> SAMPLE_BITS;
            if (is_same && is_before(uintBitsToFloat(other.y), n, depth, found)) {
                samples &= ~other.w;
            }
        }
        vec4 layer = unpackUnorm4x8(node.z) * (float(bitCount(samples)) / float(SAMPLES));
        color = color * (1.0 - layer.a) + layer;
        last_depth = depth;
        last = found;
    }
    return color;
}
