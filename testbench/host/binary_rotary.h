// A binary rotary buffer of one coordinate system as the host keeps it in the dual-ported RAM (host-bus:7.2,
// host-bus:7.4): header, lines, the end-of-buffer command behind them, the host's index last.
#pragma once

#include <cstdint>
#include <istream>
#include <string>

#include "testbench/host/binary_commands.h"
#include "testbench/host/host_bus.h"

namespace brick {

class BinaryRotary {
 public:
  BinaryRotary(HostBus& bus, unsigned cs) : bus_(bus), cs_(cs) {}  // cs: 1 to 16

  // Off, empty, at this place: `start` in PMAC addresses behind $060450, `size` in items of 32 bits.
  BinaryResult define(std::uint32_t start, std::uint32_t size);
  void enable();
  void disable();
  BinaryResult recover();  // empty again, after an error

  // kBusy: no room for it now; nothing has been written. A line of text, or of commands as they stand.
  BinaryResult put(std::string_view line);
  BinaryResult put(const std::vector<BinaryCommand>& line);
  BinaryResult feed(std::istream& lines);  // as many as there is room for; then kEndOfFile, kBusy or what is wrong

  // The same in two steps: any number of lines, then the end-of-buffer command and the index for all of them.
  BinaryResult stage(const std::vector<BinaryCommand>& line);
  void commit();

  std::uint16_t read(std::uint32_t word) { return bus_.dpram_read(header() + word); }
  void write(std::uint32_t word, std::uint16_t value) { bus_.dpram_write(header() + word, value); }
  std::uint16_t status();
  bool empty();  // all has been copied
  std::uint32_t host_index() const { return index_; }
  std::uint32_t size() const { return size_; }

 private:
  std::uint32_t header() const;
  void write_command(std::uint32_t index, const BinaryCommand& command);
  bool has_room(std::uint32_t items);

  HostBus& bus_;
  unsigned cs_;
  std::uint32_t start_ = 0, size_ = 0;
  std::uint32_t index_ = 0;       // behind what is staged
  std::uint32_t pmac_index_ = 0;  // as it was at the last look
  std::string held_;              // of feed(): the line that found no room
};

}  // namespace brick
