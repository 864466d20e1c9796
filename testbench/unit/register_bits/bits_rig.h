// One engine of the four channels with their registers, and a stuck bit between it and the bus: in the words it is
// written, or in the words read from it. A check drives the rig through write(), read() and the pins, so the same check
// that passes on the sound engine has to notice the stuck bit.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "testbench/unit/servo_channel/channels_rig.h"

namespace brick {

enum class Side { kWritten, kRead };
enum class BitsEngine { kRtl, kModel };

struct StuckBit {
  Side side = Side::kWritten;
  bool x = false;
  unsigned addr = 0, bit = 0;
  bool level = false;

  std::uint32_t apply(Side at, bool word_x, unsigned word_addr, std::uint32_t word) const {
    if (at != side || word_x != x || word_addr != addr) return word;
    return level ? word | 1u << bit : word & ~(1u << bit);
  }
};

class BitsRig {
 public:
  explicit BitsRig(BitsEngine engine) : engine_(make_channels_engine(engine == BitsEngine::kRtl)) {}

  ServoIcInputs in;
  std::optional<StuckBit> stuck;

  // All dividers 0: SCLK, PFM_CLK, DAC_CLK and ADC_CLK every 3 ticks. PHASE and SERVO are inputs.
  static constexpr std::uint32_t kFast = regs::servo_ic::kClockControl.reset & 0xFFF000;
  static constexpr Tick kHold = 18;  // long enough for synchroniser and filter at that SCLK

  // From reset to a filter that holds the pins; well before the switches' first dead time is over (240 ticks).
  void start(std::uint32_t clock_word = kFast) {
    in = ServoIcInputs{};
    in.rst_n = false;
    run(4);
    in.rst_n = true;
    write(true, 0x04, clock_word);
    run(48);
  }

  void tick() { run(1); }
  void run(Tick n) { engine_->run(in, now_ += std::max<Tick>(n, 0)); }
  void write(bool x, unsigned addr, std::uint32_t word) {
    in.wdata = stuck ? stuck->apply(Side::kWritten, x, addr, word) : word;
    in.we = true;
    to_ref(x, addr);
    in.we = false;
  }
  std::uint32_t peek(bool x, unsigned addr) {
    in.x = x;
    in.addr = addr;
    const std::uint32_t word = engine_->word(in);
    return stuck ? stuck->apply(Side::kRead, x, addr, word) : word;
  }
  // With the side effect of a bus read.
  std::uint32_t read(bool x, unsigned addr) {
    const std::uint32_t word = peek(x, addr);
    in.rd = true;
    to_ref(x, addr);
    in.rd = false;
    return word;
  }
  // The same by name: a word of the IC, a word of a channel (1..4).
  void write(const regs::Register& word, std::uint32_t value) { write(word.space == 'X', word.address, value); }
  void write(unsigned channel, const regs::Register& word, std::uint32_t value) {
    write(word.space == 'X', base(channel) + word.address, value);
  }
  std::uint32_t peek(unsigned channel, const regs::Register& word) {
    return peek(word.space == 'X', base(channel) + word.address);
  }
  std::uint32_t read(unsigned channel, const regs::Register& word) {
    return read(word.space == 'X', base(channel) + word.address);
  }
  bool bit(unsigned channel, const regs::Register& word, unsigned n) { return (peek(channel, word) >> n & 1) != 0; }
  bool bit(bool x, unsigned addr, unsigned n) { return (peek(x, addr) >> n & 1) != 0; }

  void pin(unsigned channel, unsigned n, bool level, Tick hold = kHold) {
    unsigned& pins = in.pins[channel - 1];
    pins = level ? pins | 1u << n : pins & ~(1u << n);
    run(hold);
  }
  // One quarter cycle of A and B; A leads upwards.
  void step(unsigned channel, bool up, Tick hold = kHold) {
    constexpr unsigned kAb[4] = {0, 1, 3, 2}, kPlace[4] = {0, 1, 3, 2};  // {B, A} by place in the cycle, and back
    unsigned& pins = in.pins[channel - 1];
    pins = (pins & ~3u) | kAb[(kPlace[pins & 3] + (up ? 1 : 3)) & 3];
    run(hold);
  }
  void steps(unsigned channel, int n, bool up, Tick hold = kHold) {
    while (n-- > 0) step(channel, up, hold);
  }
  // PHASE and SERVO fall and rise again: both latch, and the serial streams start.
  void latch() {
    in.phase = in.servo = false;
    run(12);
    in.phase = in.servo = true;
    run(12);
  }

  ChannelPins pins() const { return engine_->pins(); }
  unsigned pwm(unsigned channel) const { return pins().pwm >> (6 * (channel - 1)) & 0x3F; }
  bool other(unsigned group, unsigned channel) const { return (pins().others >> (4 * group + channel - 1) & 1) != 0; }
  Tick now() const { return now_; }
  // Ticks until `condition` holds, or `limit`.
  template <class Condition>
  Tick until(Tick limit, Condition condition) {
    Tick n = 0;
    for (; n < limit && !condition(); ++n) tick();
    return n;
  }

 private:
  void to_ref(bool x, unsigned addr) {
    in.x = x;
    in.addr = addr;
    do tick();
    while (now_ % kTicksPerRef != 0);
  }

  std::unique_ptr<ChannelsEngine> engine_;
  Tick now_ = 0;
};

// One bit of one word, on the side on which it could be stuck, and what shows that it is not. `check` starts from reset
// and returns whether the bit could be seen as 0 and as 1 where it had to be.
struct BitRow {
  std::string name;
  Side side;
  bool x;
  unsigned offset;  // in the channel; in the IC for the registers of the IC
  unsigned bit;
  bool global;    // a register of the IC
  bool always_0;  // reads 0 whatever happens: stuck at 0 is no fault
  std::function<bool(BitsRig&, unsigned channel)> check;

  unsigned addr(unsigned channel) const { return global ? offset : base(channel) + offset; }
};
using BitTable = std::vector<BitRow>;

void add_channel_rows(BitTable& table);  // words of a channel but its timers, which need millions of SCLK periods
void add_control_rows(BitTable& table);  // the control word, of those
void add_output_rows(BitTable& table);   // OUT A, B, C and the ADC words
void add_global_rows(BitTable& table);   // X:+4 of each channel

// What every readable and writable word has: its bits read back as written.
void add_read_back(BitTable& table, const char* name, bool x, unsigned offset, bool global, std::uint32_t kept);

}  // namespace brick
