// encoder: all channels at once, each with its own decode mode, under random movement with glitches, jumps of both
// lines and turns. Every change of every counter is judged to the tick by testbench/checkers/channel_scoreboard.h,
// which sees the same pins; then the words that a host reads: positions, status, timers, and the fraction of hardware
// 1/T.
#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/channel_host.h"
#include "testbench/benches/encoder_moves.h"

namespace brick {
namespace {

constexpr unsigned kA = EncoderMoves::kA, kB = EncoderMoves::kB, kC = EncoderMoves::kC;
constexpr Tick kServo = 4 * (2 * 6527 + 3);  // factory setting
// M-variables, + 100 for each further channel.
constexpr unsigned kStatus = 100, kPhase = 101, kServoWord = 102, kT1 = 103, kT2 = 104, kError = 105, kReset = 106,
                   kLoss = 107, kOutC = 108;

class EncoderBench {
 public:
  explicit EncoderBench(BenchContext& b) : b_(b), host_(b) {
    for (unsigned i = 0; b.negative && i < host_.channels(); ++i) host_.board(i).samples = 1;
  }

  void run() {
    define();
    host_.sclk(1 + host_.pick(3));
    std::vector<unsigned> modes(16);
    std::iota(modes.begin(), modes.end(), 0u);
    std::shuffle(modes.begin(), modes.end(), host_.random());
    for (unsigned first = 0; first < modes.size(); first += host_.channels()) {
      const auto from = modes.begin() + first;
      random_movement({from, from + static_cast<long>(std::min<std::size_t>(host_.channels(), modes.size() - first))});
    }
    illegal_moves();
    set_modes(std::vector<unsigned>(host_.channels(), 3 + 4 * host_.pick(2)));
    timers();
    counter_reset();
    encoder_loss();
    own_pulses();
    mldt();
    fraction();
  }

 private:
  void define() {
    host_.define(kStatus, 'X', 0, "0,24");
    host_.define(kPhase, 'X', 1, "0,24,S");
    host_.define(kServoWord, 'X', 2, "0,24");
    host_.define(kT1, 'Y', 0, "0,24");
    host_.define(kT2, 'Y', 1, "0,24");
    host_.define(kError, 'X', 0, "8");
    host_.define(kReset, 'X', 5, "10");
    host_.define(kLoss, 'X', 0, "7");
    host_.define(kOutC, 'Y', 4, "0,24,S");
  }

  void all(unsigned number, long value) { host_.ask(fmt::format("M{},{},100={}", number, host_.channels(), value)); }

  void set_modes(const std::vector<unsigned>& modes) {
    host_.assign(0, modes);
    for (unsigned i = 0; i < modes.size(); ++i) {
      ChannelScoreboard& board = host_.board(i);
      if (board.decoder.mode == 12) board.decoder.clear_timing();  // T1 was an echo
      board.decoder.mode = modes[i];
      board.touch();
    }
  }

  void random_movement(const std::vector<unsigned>& modes) {
    set_modes(modes);
    all(kError, 0);
    for (unsigned i = 0; i < modes.size(); ++i) host_.board(i).decoder.clear_error();
    const Tick start = host_.now() + 100;
    for (unsigned i = 0; i < modes.size(); ++i)
      host_.drive(i, start + host_.pick(200), moves_.random(modes[i], host_.pins(i), 400));
    host_.play();
    for (unsigned i = 0; i < modes.size(); ++i) {
      const std::int32_t position = host_.board(i).decoder.counter();
      const auto d = host_.counts(i);
      const bool still =
          modes[i] == 8 || modes[i] == 12 || modes[i] == 9 || modes[i] == 10 || modes[i] == 13 || modes[i] == 14;
      const bool enough = still ? d.events == 0 : d.events > 20;
      b_.report.step(
          fmt::format("{} I7mn0={}", host_.name(i), modes[i]), d.text.empty() && enough,
          d.text.empty() ? fmt::format("{} counts, each at its tick, position {}", d.events, position) : d.text);
    }
    b_.bus.wait(2 * kServo);
    words("positions, status and T1 of all channels", static_cast<unsigned>(modes.size()));
    all(kError, 0);
    const auto status = host_.read(kStatus);
    unsigned wrong = 0;
    for (unsigned i = 0; i < modes.size(); ++i) {
      host_.board(i).decoder.clear_error();
      wrong += (static_cast<unsigned>(status[i]) >> 8 & 1) != (host_.board(i).decoder.error() ? 1u : 0u);
    }
    b_.report.equal<std::int64_t>("count error after a write of 0, wrong channels", wrong, 0);
  }

  // One illegal move at a time: three lines at once, then hall lines that are no state. Pulse and direction knows no
  // error.
  void illegal_moves() {
    const std::vector<unsigned> modes{1, 2, 3, 11, 15, 5, 0, 4};
    set_modes(
        {modes.begin(), modes.begin() + static_cast<long>(std::min<std::size_t>(host_.channels(), modes.size()))});
    const auto put = [&](unsigned lines) {
      for (unsigned i = 0; i < host_.channels(); ++i)
        host_.drive(i, host_.now() + 50, {{static_cast<std::uint16_t>((host_.pins(i) & ~(kA | kB | kC)) | lines), 1}});
      host_.play();
    };
    const auto errors = [&](const char* name, const std::string& expected) {
      std::string set;
      for (const long e : host_.read(kError)) set += e != 0 ? '1' : '0';
      b_.report.equal<std::string>(name, set, expected.substr(0, host_.channels()));
    };
    const auto clear = [&] {
      all(kError, 0);
      for (unsigned i = 0; i < host_.channels(); ++i) host_.board(i).decoder.clear_error();
    };
    put(kC);
    clear();
    errors("count error of modes 1 2 3 11 15 5 0 4, cleared", "00000000");
    put(kA | kB);
    errors("A, B, C from 001 to 110", "11111100");
    put(kA);
    clear();
    errors("100", "00000000");
    put(0);
    errors("000", "00011000");
    judge_counts("positions meanwhile");
  }

  // What is read while nothing moves.
  void words(const std::string& name, unsigned channels) {
    const auto status = host_.read(kStatus), phase = host_.read(kPhase), servo = host_.read(kServoWord),
               t1 = host_.read(kT1);
    constexpr std::uint32_t kJudged = 0x007100 | 0x000008;  // C, B, A, count error, DMX_INV
    std::string wrong;
    unsigned errors = 0;
    for (unsigned i = 0; i < channels; ++i) {
      const ChannelScoreboard& board = host_.board(i);
      const auto check = [&](const char* what, long measured, long expected) {
        if (measured != expected && wrong.empty())
          wrong = fmt::format("{} {}: ${:06X}, expected ${:06X}", host_.name(i), what, measured & 0xFFFFFF,
                              expected & 0xFFFFFF);
      };
      errors += board.decoder.error() ? 1 : 0;
      check("status", status[i] & kJudged, board.status(kJudged));
      check("X:+1", phase[i], board.decoder.counter());
      check("X:+2", servo[i],
            static_cast<long>((board.decoder.raw() << 1 & 0xFFFFFF) | (board.decoder.down() ? 1 : 0)));
      if (board.decoder.counts() >= 2 && board.decoder.mode != 12)
        check("T1", t1[i], static_cast<long>(board.decoder.t1() | (board.decoder.reversed() ? 0x800000u : 0u)));
    }
    b_.report.step(name, wrong.empty(),
                   wrong.empty() ? fmt::format("as the scoreboard, {} with count error", errors) : wrong);
  }

  void timers() {
    std::vector<long> spacing;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      spacing.push_back(20 + host_.pick(1000));
      host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 3, i % 2 == 0, spacing[i]));
    }
    host_.play();
    b_.bus.wait(kServo);
    const auto t1 = host_.read(kT1);
    const auto t2 = host_.read(kT2);
    std::string bad;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      const auto seen = host_.last_read(false, host_.address(i, 1));
      const long since = host_.board(i).t2(seen.servo);
      if (t1[i] != spacing[i] || std::abs(t2[i] - since) > 1)
        bad += fmt::format(" {}: T1={} T2={}, expected {} {} +-1", host_.name(i), t1[i], t2[i], spacing[i], since);
    }
    b_.report.step("T1 = spacing, T2 = SCLK periods from the count to SERVO", bad.empty(),
                   bad.empty() ? fmt::format("{}: {} and {}", host_.name(0), t1[0], t2[0]) : bad);
    for (unsigned i = 0; i < host_.channels(); ++i)
      host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 1, i % 2 != 0, 4));
    host_.play();
    b_.bus.wait(2 * kServo);
    const auto turned = host_.read(kT1);
    unsigned wrong = 0;
    for (unsigned i = 0; i < host_.channels(); ++i) wrong += (turned[i] & 0x800000) == 0;
    b_.report.equal<std::int64_t>("bit 23 of Y:+0 after a turn, missing", wrong, 0);
    words("the same by the scoreboard", host_.channels());
    judge_counts("positions until here");
  }

  void judge_counts(const std::string& name) {
    std::string bad;
    std::size_t events = 0;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      const auto d = host_.counts(i);
      events += d.events;
      if (!d.text.empty() && bad.empty()) bad = host_.name(i) + " " + d.text;
    }
    b_.report.step(name, bad.empty(), bad.empty() ? fmt::format("{} counts, each at its tick", events) : bad);
  }

  // Control bit 10: 0 and no count while it stands; a jump leaves no error.
  void counter_reset() {
    all(kReset, 1);
    for (unsigned i = 0; i < host_.channels(); ++i) {
      host_.board(i).decoder.hold = true;
      host_.board(i).touch();
      std::vector<ChannelHost::Hold> holds = moves_.even(host_.pins(i), 5, true, 4);
      holds.push_back({static_cast<std::uint16_t>(holds.back().pins ^ (kA | kB)), 5 * host_.period()});
      host_.drive(i, host_.now() + 50, holds);
    }
    host_.play();
    for (auto& seen : host_.player().seen) seen.counts.clear();  // to 0, with the bus write
    b_.bus.wait(2 * kServo);
    const auto phase = host_.read(kPhase), status = host_.read(kStatus);
    unsigned wrong = 0;
    for (unsigned i = 0; i < host_.channels(); ++i) wrong += phase[i] != 0 || (status[i] & 0x100) != 0;
    b_.report.equal<std::int64_t>("control bit 10: position 0 and no error, wrong channels", wrong, 0);
    all(kReset, 0);
    for (unsigned i = 0; i < host_.channels(); ++i) {
      host_.board(i).decoder.hold = false;
      host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 9, host_.pick(2) != 0, 3));
    }
    host_.play();
    judge_counts("counts again");
  }

  // ENC_LOSS: T = U or V = W, by two samples; it stays until 0 is written.
  void encoder_loss() {
    constexpr unsigned kLines = 1u << kT | 1u << kU | 1u << kV | 1u << kW;
    const auto with = [](std::uint16_t pins, unsigned lines) {
      return static_cast<std::uint16_t>((pins & ~kLines) | lines);
    };
    const auto losses = [&](const char* name, long expected) {
      long set = 0;
      for (const long v : host_.read(kLoss)) set += v;
      b_.report.equal<std::int64_t>(name, set, expected);
    };
    for (unsigned i = 0; i < host_.channels(); ++i)
      host_.drive(i, host_.now() + 50, {{with(host_.pins(i), 1u << kT | 1u << kW), 1}});
    host_.play();
    all(kLoss, 0);
    losses("encoder loss, complement pairs, channels", 0);
    for (unsigned i = 0; i < host_.channels(); ++i)  // one sample: no loss
      host_.drive(i, host_.now() + 50,
                  {{with(host_.pins(i), 1u << kT | 1u << kU | 1u << kW), host_.period()}, {host_.pins(i), 1}});
    host_.play();
    losses("one SCLK period with T = U", 0);
    for (unsigned i = 0; i < host_.channels(); ++i)
      host_.drive(i, host_.now() + 50,
                  {{with(host_.pins(i), i % 2 == 0 ? 1u << kT : kLines & ~(1u << kU)), 6 * host_.period()},
                   {host_.pins(i), 1}});
    host_.play();
    losses("six SCLK periods with V = W, latched", host_.channels());
    all(kLoss, 0);
    losses("0 written", 0);
  }

  // I7mn0 = 8: the counter follows the channel's own pulses. PFM_CLK is SCLK, c = 2^24 / n gives a pulse every n.
  void own_pulses() {
    set_modes(std::vector<unsigned>(host_.channels(), 8));
    host_.assign(6, std::vector<unsigned>(host_.channels(), 2));
    std::vector<long> every;
    std::string line;
    b_.bus.wait(100 * host_.period());
    for (unsigned i = 0; i < host_.channels(); ++i) {
      every.push_back(64 << host_.pick(3));
      line += fmt::format("M{}={} ", kOutC + 100 * i, (host_.pick(2) != 0 ? -1 : 1) * (1 << 24) / every[i]);
    }
    host_.ask(line);
    b_.bus.wait(4 * kServo);
    all(kOutC, 0);
    b_.bus.wait(100 * host_.period());
    std::string bad;
    std::size_t total = 0;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      const auto& seen = host_.player().seen[i];
      std::int64_t position = host_.board(i).decoder.counter();
      bool good = seen.counts.size() == seen.pulses.size() && seen.pulses.size() > 20;
      for (std::size_t k = 0; good && k < seen.pulses.size(); ++k) {
        position += seen.pulses[k].value;
        const Tick after = seen.counts[k].tick - seen.pulses[k].tick;
        good = seen.counts[k].value == position && after >= 0 && after <= host_.period() + kTicksPerRef &&
               (k == 0 || seen.pulses[k].tick - seen.pulses[k - 1].tick == every[i] * host_.period());
      }
      total += seen.counts.size();
      if (!good && bad.empty())
        bad = fmt::format("{}: {} pulses, {} counts", host_.name(i), seen.pulses.size(), seen.counts.size());
    }
    b_.report.step("I7mn0=8: each own pulse counts, with its sign", bad.empty(),
                   bad.empty() ? fmt::format("{} pulses", total) : bad);
    host_.play();
    for (unsigned i = 0; i < host_.channels(); ++i) host_.counts(i);
  }

  // I7mn0 = 12: T1 is the time from the own pulse to the echo on A. The pulse is on an SCLK edge,
  // the echo is decoded at the third one after its pin; the clearing may take one and the copy is of the value before
  // the edge.
  void mldt() {
    set_modes(std::vector<unsigned>(host_.channels(), 12));
    for (unsigned i = 0; i < host_.channels(); ++i)
      host_.drive(i, host_.now() + 50, {{static_cast<std::uint16_t>(host_.pins(i) & ~kA), 1}});
    host_.play();
    std::vector<long> delay;
    for (unsigned i = 0; i < host_.channels(); ++i) delay.push_back(60 + host_.pick(300));
    host_.player().on_pulse = [&](Tick tick, unsigned i) {
      const auto low = static_cast<std::uint16_t>(host_.pins(i) & ~kA);
      host_.player().add({tick + delay[i] * host_.period(), i, static_cast<std::uint16_t>(low | kA)});
      host_.player().add({tick + (delay[i] + 40) * host_.period(), i, low});
    };
    all(kOutC, (1 << 24) / 512);
    std::vector<long> first, second;
    const auto measure = [&] {
      b_.bus.wait(2 * kServo + 1024 * host_.period());
      return host_.read(kT1);
    };
    first = measure();
    for (long& d : delay) d += 37;
    second = measure();
    std::string bad;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      const long late = first[i] - (delay[i] - 37);
      if (late < 1 || late > 3 || second[i] - first[i] != 37)
        bad += fmt::format(" {}: {} then {}, expected {} + 1..3 and 37 more", host_.name(i), first[i], second[i],
                           delay[i] - 37);
    }
    b_.report.step("I7mn0=12: T1 is the delay of the echo", bad.empty(),
                   bad.empty() ? fmt::format("{}: {} and {}", host_.name(0), first[0], second[0]) : bad);
    all(kOutC, 0);
    b_.bus.wait(1024 * host_.period());
    host_.player().on_pulse = nullptr;
    for (auto& seen : host_.player().seen) seen.clear();
    for (unsigned i = 0; i < host_.channels(); ++i) host_.board(i).decoder.clear_timing();
  }

  // Hardware 1/T: bits 23..12 of Y:+1 are e = floor(4096 T2 / T1) at SERVO, 4095 - e going down, at most 4095; 0 after
  // a turn.
  void fraction() {
    host_.assign(6, std::vector<unsigned>(host_.channels(), 0));
    set_modes(std::vector<unsigned>(host_.channels(), 3));
    host_.assign(9, std::vector<unsigned>(host_.channels(), 1));
    constexpr unsigned kSteps = 40;
    const long spacing = (6000 + host_.pick(6000)) / static_cast<long>(host_.period());
    const Tick start = host_.now() + 100;
    for (unsigned i = 0; i < host_.channels(); ++i)
      host_.drive(i, start, moves_.even(host_.pins(i), kSteps, i % 2 == 0, spacing));
    unsigned wrong = 0, seen = 0;
    std::string text;
    while (host_.now() < start + (kSteps - 2) * spacing * host_.period()) {
      b_.bus.wait(host_.pick(10'000));
      const unsigned i = host_.pick(host_.channels());
      host_.ask(fmt::format("M{}", kT2 + 100 * i));
      const auto read = host_.last_read(false, host_.address(i, 1));
      host_.board(i).advance(host_.now());
      const long t2 = since_count(i, read.servo), up = i % 2 == 0 ? 1 : 0;
      if (read.servo < start + 4 * spacing * host_.period() || t2 < 5 || t2 > spacing - 5)
        continue;  // near a count: the next SCLK period
      const auto e = [&](long t) { return std::min(4095L, 4096 * t / spacing); };
      const long lowest = up != 0 ? e(t2 - 1) : 4095 - e(t2 + 1), highest = up != 0 ? e(t2 + 1) : 4095 - e(t2 - 1);
      const long measured = read.data >> 12;
      ++seen;
      if (measured < lowest || measured > highest) {
        ++wrong;
        text = fmt::format("{}: {}, expected {} to {}", host_.name(i), measured, lowest, highest);
      } else if (wrong == 0) {
        text = fmt::format("{} reads, the last {} with T2 = {}, T1 = {}", seen, measured, t2, spacing);
      }
    }
    b_.report.step("I7mn9=1: fraction at SERVO", wrong == 0 && seen > 5, text);
    host_.play();
    b_.bus.wait(std::max<Tick>(spacing * host_.period(), kServo) + kServo);
    rest("at rest: full cell", 4095, 0);
    for (unsigned i = 0; i < host_.channels(); ++i)
      host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 1, i % 2 != 0, 5));
    host_.play();
    b_.bus.wait(2 * kServo);
    rest("after a turn: start of the new cell", 4095, 0);
    judge_counts("counts with hardware 1/T");
    host_.assign(9, std::vector<unsigned>(host_.channels(), 0));
  }

  // Even channels went up and odd ones down; after a turn even ones enter their cell from above, odd ones from below.
  void rest(const char* name, long even_channels, long odd_channels) {
    const auto words = host_.read(kT2);
    unsigned wrong = 0;
    for (unsigned i = 0; i < host_.channels(); ++i)
      wrong += words[i] >> 12 != (i % 2 == 0 ? even_channels : odd_channels);
    b_.report.step(name, wrong == 0,
                   fmt::format("{} = {}, {} = {}, expected {} and {}", host_.name(0), words[0] >> 12, host_.name(1),
                               words[1] >> 12, even_channels, odd_channels));
  }

  long since_count(unsigned i, Tick tick) {
    const auto& counts = host_.player().seen[i].counts;
    const auto next = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.tick > tick; });
    return next == counts.begin() ? 0 : static_cast<long>((tick - std::prev(next)->tick) / host_.period());
  }

  BenchContext& b_;
  ChannelHost host_;
  EncoderMoves moves_{host_};
};

void run(BenchContext& b) { EncoderBench(b).run(); }

}  // namespace

// covers: CARD-1 CARD-2
Bench encoder_bench() {
  return {"encoder",
          "all decode modes under random movement with glitches and jumps, counters to the tick, timers, hardware 1/T, "
          "MLDT",
          "the scoreboard's filter lets one sample pass",
          nullptr,
          run,
          kAServoIc};
}

}  // namespace brick
