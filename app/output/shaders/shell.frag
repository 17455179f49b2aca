flat in uint of;

out uint nearest;

void main() {
    nearest = of;
}
