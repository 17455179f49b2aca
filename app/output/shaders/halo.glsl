// Which samples of a tube lie in the gap that another leaves in it: those behind its shell.

uniform usampler2DMS shells;      // whose shell is the nearest
uniform sampler2DMS shell_depths;
uniform vec4 depth_rows;          // of the projection: clip depth and w, both linear in distance

// Radii behind a shell from where there is a gap: where tubes of two hyperedges touch, none; and of
// the same hyperedge only where it passes well behind itself.
const float NEAR = 0.6, FAR = 8.0;

float distance_at(float depth) {
    float clip = 2.0 * depth - 1.0;
    return (depth_rows.y - clip * depth_rows.w) / (depth_rows.x - clip * depth_rows.z);
}

int outside_of_halos(uint row, float radius) {
    ivec2 place = ivec2(gl_FragCoord.xy);
    float here = distance_at(gl_FragCoord.z);
    int samples = 0;
    for (int k = 0; k < SAMPLES; k++) {
        uint other = texelFetch(shells, place, k).r;
        float behind = here - distance_at(texelFetch(shell_depths, place, k).r);
        bool is_cut = other != 0u && behind > (other == row ? FAR : NEAR) * radius;
        if (!is_cut) samples |= 1 << k;
    }
    return samples;
}
