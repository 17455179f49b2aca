// Only depth is written. What is translucent casts a sieve with as many holes as it lets light
// through: an ordered pattern of 3 by 3 texels, which the filter of the map evens out.

#ifdef SIEVE
flat in float opacity;

const float PATTERN[9] = float[](0.5, 6.5, 3.5, 4.5, 8.5, 1.5, 7.5, 2.5, 5.5);
#endif

void main() {
#ifdef SIEVE
    ivec2 place = ivec2(gl_FragCoord.xy) % 3;
    if (9.0 * opacity <= PATTERN[3 * place.y + place.x]) discard;
#endif
}
