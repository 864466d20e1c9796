// A binary rotary buffer as a host keeps it, in the dual-ported RAM of the fake hardware; no rule of host-bus:7.3 is
// held unless a test holds it.
#pragma once

#include <vector>

#include "testbench/host/binary_commands.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/base/dpram.h"
}

namespace platform {

struct BinaryBuffer {
  static constexpr brick::BinaryCommand kEnd = {0x000800, 0xFFFF};

  unsigned cs = 1;  // 1 to 16
  std::uint32_t start = 0, size = 64, index = 0;

  std::uint32_t header(std::uint32_t word) const {
    return DPRAM_ROTARY_HEADERS + DPRAM_ROTARY_STRIDE * (cs - 1) + word;
  }
  std::uint32_t read(std::uint32_t word) const { return dpram_read(header(word)); }
  void write(std::uint32_t word, std::uint32_t value) const { dpram_write(header(word), value); }
  std::uint32_t status() const { return read(DPRAM_ROTARY_STATUS); }
  std::uint32_t pmac_index() const { return read(DPRAM_ROTARY_PMAC_INDEX); }

  void set_up() {
    index = 0;
    write(DPRAM_ROTARY_ENABLE, 0);
    for (const std::uint32_t word : {DPRAM_ROTARY_STATUS, DPRAM_ROTARY_HOST_INDEX, DPRAM_ROTARY_PMAC_INDEX})
      write(word, 0);
    write(DPRAM_ROTARY_SIZE, size);
    write(DPRAM_ROTARY_START, start);
    write(DPRAM_ROTARY_ENABLE, cs);
  }
  void command(std::uint32_t at, const brick::BinaryCommand& c) const {
    const std::uint32_t offset = DPRAM_OPEN + DPRAM_ITEM_BYTES * (start + at);
    dpram_write_item(offset, c.first);
    dpram_write_item(offset + DPRAM_ITEM_BYTES, c.second);
  }
  void stage(const std::vector<brick::BinaryCommand>& line) {
    for (const brick::BinaryCommand& c : line) {
      command(index, c);
      index = (index + 2) % size;
    }
  }
  void commit() const {
    command(index, kEnd);
    write(DPRAM_ROTARY_HOST_INDEX, index);
  }
  void put(const std::vector<brick::BinaryCommand>& line) {
    stage(line);
    commit();
  }
  void put(const std::string& text) { put(brick::binary_line(text).commands); }
  bool has_room(const std::vector<brick::BinaryCommand>& line) const {
    return (index + size - pmac_index()) % size + 2 * line.size() + 4 <= size;
  }
};

}  // namespace platform
