#include "systemc/core/fst_map.h"

#include <sys/mman.h>
#include <unistd.h>

#include <utility>

namespace brick {

namespace {
thread_local unsigned short_files = 0;
}  // namespace

unsigned take_short_fst_files() { return std::exchange(short_files, 0); }

}  // namespace brick

// What fstapi.c calls in place of mmap (CMakeLists.txt); its munmap takes it back. The library maps a file again only
// when signals are declared after the first value, which nobody here does: so what it changes need not go to the file.
extern "C" void* brick_fst_mmap(void* address, size_t length, int protection, int, int file, off_t offset) {
  void* const memory = mmap(address, length, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return memory;
  size_t filled = 0;
  while (filled < length) {
    const ssize_t part =
        pread(file, static_cast<char*>(memory) + filled, length - filled, offset + static_cast<off_t>(filled));
    if (part <= 0) break;
    filled += static_cast<size_t>(part);
  }
  if (filled < length) ++brick::short_files;
  return memory;
}
