// capture-compare: positions captured and compared while all channels move. Every trigger code with every flag (64
// pairs, shuffled over the channels by the seed), gated and de-multiplexed index, U, V, W edges, software; compare with
// auto-increment both ways, on the own counter or that of channel 1, EQU written by the host, and EQU as an interrupt.
// Judged by testbench/checkers/channel_scoreboard.h.
#include <algorithm>

#include <fmt/format.h>

#include "systemc/machine/board_family.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/channel_host.h"

namespace brick {
namespace {

// M-variables, + 100 for each further channel; 108 to 117 as usual for Turbo PMAC.
constexpr unsigned kStatus = 100, kCaptured = 103, kCompareA = 108, kCompareB = 109, kIncrement = 110, kEquWrite = 111,
                   kEquState = 112, kEquBit = 116, kCaptBit = 117;
// Of the status: all but encoder loss and the bits that read 0.
constexpr std::uint32_t kJudged = span(word::status::kHallCapture, word::status::kDemuxInvalid).mask() |
                                  span(word::status::kEncoderError, word::status::kFlagT).mask();

class CaptureCompareBench {
 public:
  explicit CaptureCompareBench(BenchContext& b) : b_(b), host_(b) {
    for (unsigned i = 0; b.negative && i < host_.channels(); ++i) host_.board(i).compare.on_arrival = true;
  }

  void run() {
    host_.define(kStatus, word::kStatus);
    host_.define(kCaptured, word::kFlagPosition, true);
    host_.define(kCompareA, word::kCompareA, true);
    host_.define(kCompareB, word::kCompareB, true);
    host_.define(kIncrement, word::kCompareIncrement, true);
    host_.define(kEquWrite, word::kControl, false, word::control::kEquWrite);
    host_.define(kEquState, word::kControl, false, word::control::kEquState);
    host_.define(kEquBit, word::kStatus, false, word::status::kEqu);
    host_.define(kCaptBit, word::kStatus, false, word::status::kCaptured);
    host_.sclk(1 + host_.pick(3));
    std::vector<unsigned> decode(host_.channels());
    for (unsigned& d : decode) d = 3 + 4 * host_.pick(2);
    set(0, decode, [](ChannelScoreboard& s, unsigned v) { s.decoder.mode = v; });
    capture_pairs();
    software();
    compare();
    equ_by_host();
    interrupts();
  }

 private:
  using Apply = void (*)(ChannelScoreboard&, unsigned);
  void set(unsigned k, const std::vector<unsigned>& values, Apply apply) {
    host_.assign(k, values);
    for (unsigned i = 0; i < values.size(); ++i) {
      apply(host_.board(i), values[i]);
      host_.board(i).touch();
    }
  }
  void write(unsigned number, const std::vector<long>& values) {
    std::string line;
    for (unsigned i = 0; i < values.size(); ++i)
      line += fmt::format("{}M{}={}", i == 0 ? "" : " ", number + 100 * i, values[i]);
    host_.ask(line);
  }
  std::vector<unsigned> random_values(unsigned count) {
    std::vector<unsigned> v(host_.channels());
    for (unsigned& x : v) x = host_.pick(count);
    return v;
  }

  // A and B walk with turns; the other lines of `noise` change at any time.
  std::vector<ChannelHost::Hold> walk(std::uint16_t pins, unsigned steps, unsigned noise, unsigned turns) {
    std::vector<ChannelHost::Hold> holds;
    bool a_leads = host_.pick(2) != 0;
    const auto sclk = static_cast<unsigned>(host_.period());
    for (unsigned i = 0; i < steps; ++i) {
      if (host_.pick(turns) == 0) a_leads = !a_leads;
      pins = wheel_step(pins, a_leads);
      holds.push_back({pins, 2 * sclk + host_.pick(2 * sclk)});
      for (unsigned n = 0; noise != 0 && n < 2; ++n) {
        pins = static_cast<std::uint16_t>(pins ^ (1u << host_.pick(kChannelPins) & noise));
        holds.push_back({pins, 1 + host_.pick(3 * sclk)});
      }
    }
    holds.push_back({pins, 4 * sclk});
    return holds;
  }

  // Status, X:+3 and status again of all channels against the scoreboards; the read arms.
  unsigned judge(const std::string& name, const std::string& detail) {
    const auto status = host_.read(kStatus), captured = host_.read(kCaptured), after = host_.read(kCaptBit);
    Comparison same;
    unsigned taken = 0;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      ChannelScoreboard& board = host_.board(i);
      const Capture& c = board.capture;
      const std::string who =
          fmt::format("{} I7mn2={} I7mn3={} I7mn4={} I7mn5={}", host_.name(i), c.code, c.flag, c.gated ? 1 : 0, c.gate);
      same.word(who + " status", status[i] & kJudged, board.status(kJudged));
      taken += c.captured() ? 1 : 0;
      if (c.captured()) b_.report.cover(fmt::format("captured, I7mn2={}", c.code), 1);
      same.word(who + " X:+3", captured[i], board.capture.read());
      same.equal(who + " captured bit after the read", after[i], 0);
    }
    b_.report.step(name, same, 3 * host_.channels(), fmt::format("{} captured{}", taken, detail));
    return taken;
  }

  // All pairs of I7mn2 and I7mn3, one a channel and round, half of them with I7mn4 and I7mn5.
  void capture_pairs() {
    std::vector<unsigned> pairs(64);
    for (unsigned i = 0; i < pairs.size(); ++i) pairs[i] = i;
    std::shuffle(pairs.begin(), pairs.end(), host_.random());
    constexpr unsigned kNoise =
        1u << kEncC | 1u << kHmfl | 1u << kPlim | 1u << kMlim | 1u << kUser | 1u << kU | 1u << kV | 1u << kW;
    unsigned taken = 0;
    for (unsigned first = 0; first < pairs.size(); first += host_.channels()) {
      const unsigned round = first / host_.channels() + 1;
      std::vector<unsigned> codes, flags;
      std::string shown;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        codes.push_back(pairs[first + i] / 4);
        flags.push_back(pairs[first + i] % 4);
        shown += fmt::format(" {}/{}", codes[i], flags[i]);
      }
      set(2, codes, [](ChannelScoreboard& s, unsigned v) { s.capture.code = v; });
      set(3, flags, [](ChannelScoreboard& s, unsigned v) { s.capture.flag = v; });
      const bool gate = round % 2 == 0;
      set(4, gate ? random_values(2) : std::vector<unsigned>(host_.channels(), 0),
          [](ChannelScoreboard& s, unsigned v) { s.capture.gated = v != 0; });
      set(5, gate ? random_values(4) : std::vector<unsigned>(host_.channels(), 0),
          [](ChannelScoreboard& s, unsigned v) { s.capture.gate = v; });
      judge(fmt::format("round {}, set up", round),
            fmt::format(", codes/flags{}{}", shown, gate ? ", I7mn4 and I7mn5 by chance" : ""));
      const Tick start = host_.now() + 100;
      for (unsigned i = 0; i < host_.channels(); ++i)
        host_.drive(i, start + host_.pick(100), walk(host_.pins(i), 60 + host_.pick(60), kNoise, 8));
      host_.play();
      taken += judge(fmt::format("round {}, moved", round), "");
    }
    judge_counts("positions meanwhile", 8 * 64, 0);
    b_.report.step("captured while moving", taken >= 32, fmt::format("{} of 64, expected 32 or more", taken));
  }

  // Every count and every edge of EQU; so many of each there must be. Returns the edges.
  unsigned judge_counts(const std::string& name, unsigned least_counts, unsigned least_equs) {
    Comparison counts, equs;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      const auto d = host_.counts(i), e = host_.equs(i);
      counts.judged(host_.name(i) + " counter", d.text, static_cast<unsigned>(d.events));
      equs.judged(host_.name(i) + " EQU", e.text, static_cast<unsigned>(e.events));
    }
    b_.report.step(name + ", counters", counts, least_counts,
                   fmt::format("{} counts, each at its tick", counts.made()));
    b_.report.step(name + ", EQU", equs, least_equs, fmt::format("{} edges, each at its tick", equs.made()));
    return equs.made();
  }

  // 0 -> 4 or 8 -> 12 captures where the counter stands; armed again by the read, 4 alone does nothing.
  void software() {
    const unsigned n = host_.channels();
    set(4, std::vector<unsigned>(n, 0), [](ChannelScoreboard& s, unsigned v) { s.capture.gated = v != 0; });
    std::vector<unsigned> base(n);
    for (unsigned& c : base) c = 8 * host_.pick(2);
    const auto code = [](ChannelScoreboard& s, unsigned v) { s.capture.code = v; };
    const auto plus_4 = [&] {
      std::vector<unsigned> v = base;
      for (unsigned& c : v) c += 4;
      return v;
    };
    set(2, base, code);
    judge("I7mn2=0 or 8", "");
    set(2, plus_4(), code);
    b_.report.equal<std::int64_t>("I7mn2=4 or 12 captures, channels", judge("as the scoreboard", ""), n);
    for (unsigned i = 0; i < n; ++i) host_.drive(i, host_.now() + 50, walk(host_.pins(i), 20, 0, 8));
    host_.play();
    b_.report.equal<std::int64_t>("armed again at 4 or 12 and moved, captures", judge("as the scoreboard", ""), 0);
    set(2, base, code);
    set(2, plus_4(), code);
    b_.report.equal<std::int64_t>("back and again, captures", judge("as the scoreboard", ""), n);
    judge_counts("positions meanwhile", 8 * n, 0);
  }

  // The channel whose counter channel `i` compares.
  unsigned source(unsigned i) { return host_.board(i).own_compare ? i : i / kChannels * kChannels; }

  void compare() {
    const unsigned least = 30 * host_.channels();  // edges of EQU: until chance has made them
    unsigned made = 0;
    const std::string first = fmt::format("I{}", host_.i_channel(0, 1));
    host_.ask(first + "=0");
    host_.expect(first, "1");
    for (unsigned round = 0; round < 3 || (made < least && round < 100); ++round) {
      std::vector<unsigned> other = random_values(2);
      if (round == 0) std::fill(other.begin(), other.end(), 0);
      host_.assign(1, other);
      std::vector<long> a, b, increment;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        const bool own = other[i] == 0 || i % kChannels == 0;
        host_.board(i).own_compare = own;
        host_.board(i).on_count = nullptr;
        if (own) continue;
        other[i] = 1;
      }
      for (unsigned first_of = 0; first_of < host_.channels(); first_of += kChannels)
        host_.board(first_of).on_count = [this, first_of](Tick tick, std::uint32_t from, int direction) {
          for (unsigned i = first_of + 1; i < first_of + kChannels; ++i)
            if (!host_.board(i).own_compare) host_.board(i).follow(tick, from, direction);
        };
      std::string shown;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        const long at = host_.board(source(i)).decoder.counter();
        const long period = 2 + host_.pick(12), width = 1 + host_.pick(static_cast<unsigned>(period - 1));
        const long up = at + host_.pick(static_cast<unsigned>(period - width));
        // A and B bracket the start; some do not.
        a.push_back(up);
        b.push_back(host_.pick(5) == 0 ? up + width : up + width - period);
        increment.push_back(period);
        ChannelScoreboard& board = host_.board(i);
        board.compare.a = static_cast<std::uint32_t>(a[i]) & 0xFFFFFF;
        board.compare.b = static_cast<std::uint32_t>(b[i]) & 0xFFFFFF;
        board.compare.increment = static_cast<std::uint32_t>(period);
        shown += fmt::format(" {}{}", period, other[i] != 0 && i % kChannels != 0 ? "*" : "");
      }
      write(kCompareA, a);
      write(kCompareB, b);
      write(kIncrement, increment);
      const Tick start = host_.now() + 100;
      for (unsigned i = 0; i < host_.channels(); ++i)
        host_.drive(i, start + host_.pick(100), walk(host_.pins(i), 300, 0, 60));
      host_.play();
      made += judge_counts(fmt::format("compare {}, increments{} (* channel 1's counter)", round + 1, shown),
                           100 * host_.channels(), 0);
      const auto a_now = host_.read(kCompareA), b_now = host_.read(kCompareB), equ = host_.read(kEquBit);
      Comparison same;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        const Compare& c = host_.board(i).compare;
        same.word(host_.name(i) + " compare A", a_now[i], c.a);
        same.word(host_.name(i) + " compare B", b_now[i], c.b);
        same.equal(host_.name(i) + " EQU", equ[i], c.equ ? 1 : 0);
      }
      b_.report.step("A, B and EQU afterwards", same, 3 * host_.channels(),
                     fmt::format("{}: A={} B={}", host_.name(0), a_now[0], b_now[0]));
    }
    b_.report.reached("edges of EQU by compare", made, least);
  }

  // Control bits 12 and 11: EQU takes bit 12 at once, bit 11 falls back by itself; later writes of the word leave EQU
  // alone.
  void equ_by_host() {
    const unsigned n = host_.channels();
    std::vector<long> state(n);
    const auto pin_is = [&](unsigned i) { return static_cast<long>(host_.pin(motor_pin::kEqu, i)); };
    for (unsigned round = 0; round < 2; ++round) {
      for (unsigned i = 0; i < n; ++i) state[i] = round == 0 ? static_cast<long>(host_.pick(2)) : 1 - state[i];
      write(kEquState, state);
      std::vector<long> before(n);
      for (unsigned i = 0; i < n; ++i) before[i] = pin_is(i);
      write(kEquWrite, std::vector<long>(n, 1));
      const auto bit = host_.read(kEquBit), fallen = host_.read(kEquWrite);
      for (unsigned i = 0; i < n; ++i) state[i] = 1 - state[i];
      write(kEquState, state);  // bit 12 alone
      for (unsigned i = 0; i < n; ++i) state[i] = 1 - state[i];
      Comparison same;
      for (unsigned i = 0; i < n; ++i) {
        same.equal(host_.name(i) + " EQU before", before[i], host_.board(i).compare.equ ? 1 : 0);
        same.equal(host_.name(i) + " EQU in the status", bit[i], state[i]);
        same.equal(host_.name(i) + " EQU pin, bit 12 written again", pin_is(i), state[i]);
        same.equal(host_.name(i) + " control bit 11", fallen[i], 0);
        host_.board(i).compare.equ = state[i] != 0;
      }
      b_.report.step("M111, M112: EQU written", same, 4 * n, fmt::format("{} comparisons", same.made()));
    }
    for (auto& seen : host_.player().seen) seen.equs.clear();
    for (unsigned i = 0; i < n; ++i) host_.board(i).equs.clear();
  }

  // Lines of the interrupt controller that the board gives to EQU outputs: 5 to EQU1 and 6 to EQU5 on a Geo Brick LV.
  void interrupts() {
    const unsigned n = host_.channels();
    host_.assign(1, std::vector<unsigned>(n, 0));
    for (unsigned i = 0; i < n; ++i) {
      host_.board(i).own_compare = true;
      host_.board(i).on_count = nullptr;
    }
    for (unsigned line = 5; line < 8; ++line) {
      const unsigned code = b_.board.line_select >> 4 * (line - 5) & 0xF;
      if (code == 0 || code > kSourceEqu8) continue;
      const auto& ics = host_.fitted();  // EQU1 to EQU4 are of servo IC 0, EQU5 to EQU8 of servo IC 1
      const auto place = std::find(ics.begin(), ics.end(), (code - 1) / kChannels);
      if (place == ics.end()) continue;
      const unsigned i = kChannels * static_cast<unsigned>(place - ics.begin()) + (code - 1) % kChannels;
      ChannelScoreboard& board = host_.board(i);
      const long at = board.decoder.counter(), passed = at + 3;
      host_.ask(fmt::format("M{}=0 M{}={} M{}={} M{}=0 M{}=1", kIncrement + 100 * i, kCompareA + 100 * i, passed,
                            kCompareB + 100 * i, at - 100, kEquState + 100 * i, kEquWrite + 100 * i));
      board.compare.a = static_cast<std::uint32_t>(passed) & 0xFFFFFF;
      board.compare.b = static_cast<std::uint32_t>(at - 100) & 0xFFFFFF;
      board.compare.increment = 0;
      board.compare.equ = false;
      for (auto& seen : host_.player().seen) seen.equs.clear();
      b_.bus.write_pic_edge_level(0);
      b_.bus.clear_pic();
      b_.bus.write_pic_mask(static_cast<std::uint8_t>(1u << line));
      // A wheel that turns up: A leads in mode 3, B in mode 7.
      std::uint16_t pins = host_.pins(i);
      std::vector<ChannelHost::Hold> holds;
      for (unsigned k = 0; k < 6; ++k) holds.push_back({pins = wheel_step(pins, board.decoder.mode == 3), 200});
      const std::uint8_t before = b_.bus.read_pic_status();
      host_.drive(i, host_.now() + 100, holds);
      const bool came = b_.bus.wait_pin(pin::kIsaIrq, 1, 5000);
      const Tick irq = host_.now();
      host_.play();
      const auto& edges = host_.player().seen[i].equs;
      const Tick rise = edges.size() == 1 ? edges[0].tick : -1;
      const std::string name = fmt::format("EQU{} leaves {} upwards: ", code, passed);
      b_.report.equal<std::int64_t>(name + "IST before", before, 0);
      // Two flip-flops on clk_ref and the edge detector of the interrupt controller.
      b_.report.step(name + fmt::format("IR{} and the interrupt", line),
                     came && rise >= 0 && irq - rise == 3 * kTicksPerRef,
                     fmt::format("IRQ {} ticks after EQU, expected {}", irq - rise, 3 * kTicksPerRef));
      const HostBus::Pic pic = b_.bus.read_pic();
      b_.report.equal<std::int64_t>("IST", pic.ist, 1 << line);
      b_.bus.clear_pic();
      b_.bus.write_pic_mask(0);
      judge_counts("at their ticks", 6, 1);
    }
  }

  BenchContext& b_;
  ChannelHost host_;
};

void run(BenchContext& b) { CaptureCompareBench(b).run(); }

}  // namespace

// covers: CARD-1 CARD-2
Bench capture_compare_bench() {
  return {
      "capture-compare",
      "every trigger code with every flag, gated and de-multiplexed index, compare both ways, EQU as an interrupt",
      {"the scoreboard's EQU toggles when a position is reached instead of left", "compare 1, *, EQU", "EQU: change"},
      run,
      without_8259(kAServoIc)};
}

}  // namespace brick
