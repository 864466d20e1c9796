// What the two stacks of an image have never used since it started (firmware/hal/stacks.h), found by looking at all of
// their words at once; the image itself shows the same, a little later, at X:$73 and Y:$73.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "firmware/hal/stacks.h"
#include "systemc/cpu/cpu.h"
#include "systemc/cpu/elf_file.h"

namespace brick {

struct StackRoom {
  std::uint32_t bytes, unused;
};

inline StackRoom stack_room(Cpu& cpu, const ElfFile& elf, const std::string& name) {
  const std::uint32_t bottom = elf.symbol("__" + name + "_bottom").value(),
                      top = elf.symbol("__" + name + "_top").value();
  const std::uint8_t* memory = cpu.memory(bottom, top - bottom);
  StackRoom room{top - bottom, 0};
  for (std::uint32_t word = STACK_MARK; room.unused < room.bytes; room.unused += 4) {
    std::memcpy(&word, memory + room.unused, 4);
    if (word != STACK_MARK) break;
  }
  return room;
}

// A quarter of each is kept for what nobody has tried yet. Both have been used, and the test reports what is left.
inline void expect_stack_room(Cpu& cpu, const ElfFile& elf) {
  for (const char* name : {"stack", "side_stack"}) {
    const StackRoom room = stack_room(cpu, elf, name);
    EXPECT_GE(room.unused, room.bytes / 4) << name;
    EXPECT_LT(room.unused, room.bytes) << name << " is not in use";
    ::testing::Test::RecordProperty(std::string(name) + "_unused_bytes", static_cast<int>(room.unused));
    std::printf("%s: %u of %u bytes never used\n", name, room.unused, room.bytes);
  }
}

}  // namespace brick
