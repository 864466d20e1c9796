// What each peer of tools/peers.py plays on one servo IC: its registers are written from a file, one in nine ticks,
// then the encoders of four channels turn, a state in 60 ticks. Before each state a word is read, in turn status,
// position at PHASE, position at SERVO and T1 of channel 1, and goes with all output pins into a checksum:
//   sum = 31 sum + word, sum = 31 sum + pins, of 64 bits
// PEER WRITES STEPS FLIP: prints 'STEP SUM' at the steps 1, 10, 100, ... and at the last. With FLIP 1 line A of channel
// 1 is turned round, so that the sum is another.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

namespace brick::peer {

constexpr std::uint64_t kWriteTicks = 9, kFirstState = 240, kStateTicks = 60;
constexpr unsigned kIdlePins = 0xF80;  // of a channel
constexpr unsigned kWords[] = {4, 12, 20, 0};

struct Write {
  unsigned address;  // 8 * offset, and 4 for X
  std::uint32_t value;
};

inline std::vector<Write> read_writes(const char* file) {
  std::vector<Write> writes;
  std::ifstream in(file);
  for (Write w; in >> std::hex >> w.address >> w.value;) writes.push_back(w);
  return writes;
}

inline std::uint64_t pins_of(std::uint64_t step, bool flip) {
  constexpr unsigned kAb[] = {0, 1, 3, 2};
  std::uint64_t pins = 0;
  for (unsigned n = 0; n < 4; ++n) pins |= std::uint64_t{kIdlePins | kAb[(step + n) & 3]} << 12 * n;
  return pins ^ (flip ? 1 : 0);
}

// Dut: run_until(tick), write(address, value) at the edge of clk_ref that comes next, set_pins(pins), select(address),
// word() there, motor().
template <class Dut>
int play(Dut& dut, int argc, char** argv) {
  if (argc != 4) return 2;
  const std::vector<Write> writes = read_writes(argv[1]);
  const std::uint64_t steps = std::strtoull(argv[2], nullptr, 10);
  const bool flip = argv[3][0] == '1';
  std::uint64_t sum = 0, mark = 1;
  dut.set_pins(pins_of(0, flip));
  for (std::size_t i = 0; i < writes.size(); ++i) {
    dut.run_until(kWriteTicks * (i + 1) - 1);
    dut.write(writes[i].address, writes[i].value);
  }
  for (std::uint64_t step = 0; step <= steps; ++step) {
    dut.select(kWords[step % 4]);
    dut.run_until(kFirstState + kStateTicks * step);
    sum = 31 * sum + dut.word();
    sum = 31 * sum + dut.motor();
    if (step == mark || step == steps) {
      std::printf("%llu %016llx\n", static_cast<unsigned long long>(step), static_cast<unsigned long long>(sum));
      while (mark <= step) mark *= 10;
    }
    dut.set_pins(pins_of(step + 1, flip));
  }
  return 0;
}

}  // namespace brick::peer
