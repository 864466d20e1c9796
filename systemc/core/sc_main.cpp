// libsystemc has a main() of its own that calls sc_main(). Our programs and tests bring their own main and elaborate
// from there, so this one is never called; it only satisfies the linker.
#include <systemc>

int sc_main(int, char*[]) { return 0; }
