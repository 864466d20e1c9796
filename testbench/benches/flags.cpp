// flags: every input pin of every channel at its bit of the status word and its M-variable, the filter before it, AENA,
// and the control word that the I-variables and M-variables share. The levels that a read must show are those of the
// scoreboard's filter at that time.
#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/channel_host.h"

namespace brick {
namespace {

constexpr std::uint16_t kAllPins = (1u << kChannelPins) - 1;
constexpr unsigned kAena = 114, kPins = 130, kControl = 131, kCaptured = 117, kPosition = 103;

// The usual M-variables of the flags and their status bits, servo-ic:2.2.
struct Flag {
  unsigned number, bit;
  ChannelPin pin;
};
constexpr std::array<Flag, 10> kFlags{{{115, 19, kUser},
                                       {119, 14, kEncC},
                                       {120, 16, kHmfl},
                                       {121, 17, kPlim},
                                       {122, 18, kMlim},
                                       {123, 15, kFault},
                                       {124, 20, kW},
                                       {125, 21, kV},
                                       {126, 22, kU},
                                       {127, 23, kT}}};

class FlagsBench {
 public:
  explicit FlagsBench(BenchContext& b) : b_(b), host_(b) {
    for (unsigned i = 0; i < host_.channels(); ++i) {
      host_.board(i).keep_levels = true;
      if (b.negative) host_.board(i).samples = 1;
    }
  }

  void run() {
    for (const Flag& f : kFlags) host_.define(f.number, 'X', 0, std::to_string(f.bit));
    host_.define(kPins, 'X', 0, "12,12");
    host_.define(kControl, 'X', 5, "0,24");
    host_.define(kAena, 'X', 5, "14");
    host_.define(kCaptured, 'X', 0, "11");
    host_.define(kPosition, 'X', 3, "0,24,S");
    host_.sclk(3 + host_.pick(2));
    levels("nothing connected");
    walking(false);
    walking(true);
    spikes();
    capture_spikes();
    aena();
  }

 private:
  void put(const std::vector<std::uint16_t>& pins) {
    for (unsigned i = 0; i < host_.channels(); ++i) host_.drive(i, host_.now() + 20, {{pins[i], 1}});
    host_.play();
  }

  // Bits 23..12 of all channels show their pins.
  bool levels(const std::string& name) {
    const auto read = host_.read(kPins);
    std::string bad;
    for (unsigned i = 0; i < host_.channels(); ++i)
      if (read[i] != host_.pins(i) && bad.empty())
        bad = fmt::format("{} ${:03X}, expected ${:03X}", host_.name(i), read[i], host_.pins(i));
    if (!name.empty() || !bad.empty())
      b_.report.step(name.empty() ? "status bits 23..12" : name, bad.empty(),
                     bad.empty() ? fmt::format("${:03X} on all channels", read[0]) : bad);
    return bad.empty();
  }

  // One pin a channel differs from the others, each in turn; and one channel's M-variables, which are not only bits of
  // one field.
  void walking(bool low) {
    unsigned good = 0, flags = 0;
    std::string bad;
    const unsigned first = host_.pick(kChannelPins);
    for (unsigned step = 0; step < kChannelPins; ++step) {
      std::vector<std::uint16_t> pins;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        const auto one = static_cast<std::uint16_t>(1u << (first + step + 5 * i) % kChannelPins);
        pins.push_back(low ? static_cast<std::uint16_t>(~one & kAllPins) : one);
      }
      put(pins);
      good += levels("") ? 1 : 0;
      const unsigned i = (step + first) % host_.channels();
      const auto read = host_.numbers(fmt::format("M{} M{}..{}", 115 + 100 * i, 119 + 100 * i, 127 + 100 * i));
      for (unsigned k = 0; k < kFlags.size(); ++k) {
        const long expected = pins[i] >> kFlags[k].pin & 1;
        const bool same = k < read.size() && read[k] == expected;
        flags += same ? 1 : 0;
        if (!same && bad.empty())
          bad = fmt::format(", M{} of {}, expected {}", kFlags[k].number + 100 * i, host_.name(i), expected);
      }
    }
    b_.report.step(fmt::format("one pin {}, each in turn", low ? "low" : "high"),
                   good == kChannelPins && flags == kChannelPins * kFlags.size(),
                   fmt::format("{} of 12 words of all channels, {} of 120 M-variables{}", good, flags, bad));
  }

  // A pulse on every pin, again and again, while the host reads. Of one SCLK period: never seen. Of two: each read
  // shows the level that the filter has at that moment; one that may fall on an edge is not judged.
  void spikes() {
    for (const unsigned length : {1u, 2u, 3u}) {
      const Tick start = host_.now() + 50, p = host_.period();
      constexpr unsigned kPulses = 1500;
      std::vector<std::uint16_t> base;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        base.push_back(static_cast<std::uint16_t>(host_.pick(kAllPins + 1u)));
        std::vector<ChannelHost::Hold> holds{{base[i], 20 * p + host_.pick(100)}};
        for (unsigned k = 0; k < kPulses; ++k) {
          holds.push_back({static_cast<std::uint16_t>(base[i] ^ kAllPins), length * p});
          holds.push_back({base[i], (length == 1 ? 3 : length) * p + host_.pick(static_cast<unsigned>(2 * p))});
        }
        host_.drive(i, start, holds);
      }
      b_.bus.wait(40 * p);
      const Tick end = start + kPulses * 4 * p;
      unsigned judged = 0, pulses = 0;
      std::string bad;
      while (host_.now() < end) {
        host_.read(kPins);
        for (unsigned i = 0; i < host_.channels(); ++i) {
          const auto read = host_.last_read(true, host_.address(i, 0));
          host_.board(i).advance(host_.now());
          const long expected = level_during(i, read.tick, read.end);
          const long shown = read.data >> 12;
          if (expected < 0) continue;
          ++judged;
          pulses += shown != base[i] ? 1 : 0;
          if (shown != expected && bad.empty())
            bad = fmt::format("{} at tick {}: ${:03X}, expected ${:03X}", host_.name(i), read.tick, shown, expected);
        }
      }
      host_.play();
      const bool enough = judged >= 10 && (length == 1 ? pulses == 0 : pulses > 0);
      b_.report.step(fmt::format("pulses of {} SCLK period{} on all pins", length, length == 1 ? "" : "s"),
                     bad.empty() && enough,
                     bad.empty() ? fmt::format("{} reads, {} of them during a pulse", judged, pulses) : bad);
    }
  }

  // The filtered level of a channel if it is the same from tick `from` to `to`, else -1.
  long level_during(unsigned i, Tick from, Tick to) {
    long level = -1;
    for (const auto& c : host_.board(i).levels) {
      if (c.tick > to) break;
      if (c.tick >= from) return -1;
      level = c.value;
    }
    return level;
  }

  // A flag that triggers the capture: not by one sample, by two.
  void capture_spikes() {
    const unsigned n = host_.channels(), turn = host_.pick(4);
    put(std::vector<std::uint16_t>(n, kIdleChannelPins & ~(1u << kUser)));
    std::vector<unsigned> codes(n), flags(n);
    for (unsigned i = 0; i < n; ++i) {
      codes[i] = i % 2 == 0 ? 2 : 10;
      flags[i] = (i / 2 + turn) % 4;
    }
    static constexpr unsigned kSelected[4] = {kHmfl, kPlim, kMlim, kUser};
    for (unsigned i = 1; i < n; i += 2)
      host_.drive(i, host_.now() + 20, {{static_cast<std::uint16_t>(host_.pins(i) | 1u << kSelected[flags[i]]), 1}});
    host_.play();
    host_.assign(3, flags);
    host_.assign(2, codes);
    host_.read(kPosition);
    for (const unsigned length : {1u, 2u}) {
      for (unsigned i = 0; i < n; ++i) {
        const auto other = static_cast<std::uint16_t>(host_.pins(i) ^ 1u << kSelected[flags[i]]);
        host_.drive(i, host_.now() + 100,
                    {{host_.pins(i), 1 + host_.pick(90)}, {other, length * host_.period()}, {host_.pins(i), 1}});
      }
      host_.play();
      long captured = 0;
      for (const long c : host_.read(kCaptured)) captured += c;
      b_.report.equal<std::int64_t>(fmt::format("HMFL, PLIM, MLIM, USER for {} SCLK period{}, channels that captured",
                                                length, length == 1 ? "" : "s"),
                                    captured, length == 1 ? 0 : n);
    }
  }

  bool enabled(unsigned i) { return host_.pin(motor_pin::kAena, i) != 0; }
  std::string enables(const std::vector<long>* expected = nullptr) {
    std::string text;
    for (unsigned i = 0; i < host_.channels(); ++i)
      text += expected != nullptr ? std::to_string((*expected)[i]) : enabled(i) ? "1" : "0";
    return text;
  }

  // Bits of the control word that belong to I7mnk, servo-ic:2.5: lowest bit and width.
  static constexpr std::array<std::array<unsigned, 2>, 10> kFields{
      {{0, 4}, {13, 1}, {4, 4}, {8, 2}, {15, 1}, {16, 2}, {22, 2}, {20, 2}, {19, 1}, {18, 1}}};

  void aena() {
    const unsigned n = host_.channels();
    std::vector<long> on(n, 0);
    b_.report.equal<std::string>("AENA of all channels", enables(), enables(&on));
    for (unsigned i = 0; i < n; ++i) on[i] = host_.pick(2);
    on[host_.pick(n)] = 1;
    const auto write = [&] {
      std::string line;
      for (unsigned i = 0; i < n; ++i) line += fmt::format("M{}={} ", kAena + 100 * i, on[i]);
      host_.ask(line);
    };
    write();
    b_.report.equal<std::string>("M114 ... written", enables(), enables(&on));
    // Faults and limits are reported, no more.
    put(std::vector<std::uint16_t>(n, static_cast<std::uint16_t>(kAllPins)));
    levels("FAULT and all flags high");
    b_.report.equal<std::string>("AENA with a fault", enables(), enables(&on));
    // All I-variables of all channels; the word is theirs and the M-variable's together.
    std::vector<std::uint32_t> words(n);
    for (unsigned i = 0; i < n; ++i) words[i] = static_cast<std::uint32_t>(on[i]) << 14;
    for (unsigned k = 0; k < kFields.size(); ++k) {
      std::vector<unsigned> values(n);
      for (unsigned i = 0; i < n; ++i) {
        values[i] = host_.pick(1u << kFields[k][1]);
        const bool first = k == 1 && i % kChannels == 0;  // I7m11 is no choice
        if (!first) words[i] |= values[i] << kFields[k][0];
      }
      host_.assign(k, values);
    }
    constexpr std::uint32_t kJudged = 0xFFFFFF & ~(1u << 12);
    const auto judge = [&](const char* name) {
      const auto read = host_.read(kControl);
      std::string bad;
      for (unsigned i = 0; i < n; ++i) {
        const std::uint32_t mask = i % kChannels == 0 ? kJudged & ~(1u << 13) : kJudged;
        if ((read[i] & mask) != (words[i] & mask) && bad.empty())
          bad = fmt::format("{} X:+5 = ${:06X}, expected ${:06X}", host_.name(i), read[i], words[i]);
      }
      b_.report.step(name, bad.empty(), bad.empty() ? fmt::format("{} X:+5 = ${:06X}", host_.name(0), read[0]) : bad);
    };
    judge("control words after I7mn0 to I7mn9");
    b_.report.equal<std::string>("AENA meanwhile", enables(), enables(&on));
    for (unsigned i = 0; i < n; ++i) {
      on[i] = 1 - on[i];
      words[i] ^= 1u << 14;
    }
    write();
    b_.report.equal<std::string>("M114 ... the other way", enables(), enables(&on));
    judge("control words");
    std::vector<long> off(n, 0);
    on = off;
    write();
    b_.report.equal<std::string>("all off", enables(), enables(&off));
  }

  BenchContext& b_;
  ChannelHost host_;
};

void run(BenchContext& b) { FlagsBench(b).run(); }

}  // namespace

// covers: CARD-1 CARD-2
Bench flags_bench() {
  return {"flags",
          "every input pin at its status bit and M-variable, the filter, AENA and the control word",
          "the scoreboard's filter lets one sample pass",
          nullptr,
          run,
          kAServoIc};
}

}  // namespace brick
