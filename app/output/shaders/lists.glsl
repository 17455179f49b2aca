// For each pixel a list of the translucent surfaces in it, in no order.

layout(std430, binding = 0) buffer Lists {
    uint count;                   // of nodes, even where there is no room for them
    uint most;
    uvec2 unused;
    uvec4 nodes[];                // (number of the next, depth, colour, row and samples)
};

const int SAMPLE_BITS = 4;
const uint ALL = (1u << SAMPLE_BITS) - 1u;
