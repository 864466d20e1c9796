// flags: every input pin of every channel at its bit of the status word and its M-variable, the filter before it, AENA,
// and the control word that the I-variables and M-variables share. The levels that a read must show are those of the
// scoreboard's filter at that time.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/channel_host.h"

namespace brick {
namespace {

constexpr std::uint16_t kAllPins = (1u << kChannelPins) - 1;
constexpr unsigned kAena = 114, kPins = 130, kControl = 131, kCaptured = 117, kPosition = 103;

// The usual M-variables of the flags and their status bits, servo-ic:2.2.
struct Flag {
  unsigned number;
  regs::Field bit;
  ChannelPin pin;
};
constexpr std::array<Flag, 10> kFlags{{{115, word::status::kUser, kUser},
                                       {119, word::status::kChc, kEncC},
                                       {120, word::status::kHmfl, kHmfl},
                                       {121, word::status::kPlim, kPlim},
                                       {122, word::status::kMlim, kMlim},
                                       {123, word::status::kFault, kFault},
                                       {124, word::status::kFlagW, kW},
                                       {125, word::status::kFlagV, kV},
                                       {126, word::status::kFlagU, kU},
                                       {127, word::status::kFlagT, kT}}};
constexpr regs::Field kLevels = span(word::status::kCha, word::status::kFlagT);  // all input pins

class FlagsBench {
 public:
  explicit FlagsBench(BenchContext& b) : b_(b), host_(b) {
    for (unsigned i = 0; i < host_.channels(); ++i) {
      host_.board(i).keep_levels = true;
      if (b.negative) host_.board(i).filter.lets_one_pass = true;
    }
  }

  void run() {
    for (const Flag& f : kFlags) host_.define(f.number, word::kStatus, false, f.bit);
    host_.define(kPins, word::kStatus, false, kLevels);
    host_.define(kControl, word::kControl);
    host_.define(kAena, word::kControl, false, word::control::kAena);
    host_.define(kCaptured, word::kStatus, false, word::status::kCaptured);
    host_.define(kPosition, word::kFlagPosition, true);
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
  void compare_levels(Comparison& same, const std::string& when) {
    const auto read = host_.read(kPins);
    for (unsigned i = 0; i < host_.channels(); ++i)
      same.word(fmt::format("{} status bits 23..12, {}", host_.name(i), when), read[i], host_.pins(i));
  }
  void levels(const std::string& name) {
    Comparison same;
    compare_levels(same, name);
    b_.report.step(name, same, host_.channels(), fmt::format("status bits 23..12 of {} channels", same.made()));
  }

  // One pin a channel differs from the others, each in turn; and one channel's M-variables, which are not only bits of
  // one field.
  void walking(bool low) {
    Comparison same;
    const unsigned first = host_.pick(kChannelPins);
    for (unsigned step = 0; step < kChannelPins; ++step) {
      std::vector<std::uint16_t> pins;
      for (unsigned i = 0; i < host_.channels(); ++i) {
        const auto one = static_cast<std::uint16_t>(1u << (first + step + 5 * i) % kChannelPins);
        pins.push_back(low ? static_cast<std::uint16_t>(~one & kAllPins) : one);
      }
      put(pins);
      compare_levels(same, fmt::format("pattern {}", step + 1));
      const unsigned i = (step + first) % host_.channels();
      const auto read = host_.numbers(fmt::format("M{} M{}..{}", 115 + 100 * i, 119 + 100 * i, 127 + 100 * i));
      for (unsigned k = 0; k < std::min(read.size(), kFlags.size()); ++k)
        same.equal(fmt::format("{} M{}", host_.name(i), kFlags[k].number + 100 * i), read[k],
                   pins[i] >> kFlags[k].pin & 1);
    }
    constexpr unsigned kVariables = kChannelPins * kFlags.size();
    b_.report.step(fmt::format("one pin {}, each in turn", low ? "low" : "high"), same,
                   kChannelPins * host_.channels() + kVariables,
                   fmt::format("12 words of {} channels, {} M-variables", host_.channels(), kVariables));
  }

  // A pulse on every pin, again and again, while the host reads. Of one SCLK period: never seen. Of two: each read
  // shows the level that the filter has at that moment; one that may fall on an edge is not judged.
  void spikes() {
    for (const unsigned length : {1u, 2u, 3u}) {
      const Tick start = host_.now() + 50, p = host_.period();
      constexpr unsigned kPulses = 4000;  // every third read or more is one of a pulse
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
      Comparison same;
      unsigned pulses = 0;
      while (host_.now() < end) {
        host_.read(kPins);
        for (unsigned i = 0; i < host_.channels(); ++i) {
          const auto read = host_.last_read(i, word::kStatus);
          host_.board(i).advance(host_.now());
          const long expected = level_during(i, read.tick, read.end);
          if (expected < 0) continue;
          const long shown = kLevels.get(read.data);
          pulses += shown != base[i] ? 1 : 0;
          same.word(fmt::format("{} bits 23..12 at tick {}", host_.name(i), read.tick), shown, expected);
        }
      }
      host_.play();
      const std::string name = fmt::format("pulses of {} SCLK period{} on all pins", length, length == 1 ? "" : "s");
      b_.report.step(name, same, 10, fmt::format("{} reads, {} of them during a pulse", same.made(), pulses));
      b_.report.step(name + " seen", length == 1 ? pulses == 0 : pulses > 0,
                     fmt::format("{} times, expected {}", pulses, length == 1 ? "never" : "once or more"));
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
    put(std::vector<std::uint16_t>(n, b_.machine.idle_channel_pins() & ~(1u << kUser)));
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
      const auto captured = host_.read(kCaptured);
      Comparison same;
      for (unsigned i = 0; i < n; ++i)
        same.equal(fmt::format("{} I7mn2={} I7mn3={} captured", host_.name(i), codes[i], flags[i]), captured[i],
                   length == 1 ? 0 : 1);
      b_.report.step(fmt::format("HMFL, PLIM, MLIM, USER for {} SCLK period{}", length, length == 1 ? "" : "s"), same,
                     n, fmt::format("{} channels captured", length == 1 ? "no" : "all"));
    }
  }

  bool enabled(unsigned i) { return host_.pin(motor_pin::kAena, i) != 0; }
  std::string enables(const std::vector<long>* expected = nullptr) {
    std::string text;
    for (unsigned i = 0; i < host_.channels(); ++i)
      text += expected != nullptr ? std::to_string((*expected)[i]) : enabled(i) ? "1" : "0";
    return text;
  }

  // Bits of the control word that belong to I7mnk, servo-ic:2.5.
  static constexpr std::array<regs::Field, 10> kFields{
      {word::control::kDecode, word::control::kCompareChannel,
       span(word::control::kCaptureSource, word::control::kFlagInvert), word::control::kFlagSelect,
       word::control::kGatedIndex, span(word::control::kGateState, word::control::kIndexDemux),
       span(word::control::kAbDac, word::control::kCPfm), span(word::control::kAbInvert, word::control::kCInvert),
       word::control::kPfmDirInvert, word::control::kHardware1t}};

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
    for (unsigned i = 0; i < n; ++i) words[i] = word::control::kAena.set(0, static_cast<std::uint32_t>(on[i]));
    for (unsigned k = 0; k < kFields.size(); ++k) {
      std::vector<unsigned> values(n);
      for (unsigned i = 0; i < n; ++i) {
        values[i] = host_.pick(1u << kFields[k].width);
        const bool first = k == 1 && i % kChannels == 0;  // I7m11 is no choice
        if (!first) words[i] = kFields[k].set(words[i], values[i]);
      }
      host_.assign(k, values);
    }
    const auto judge = [&](const char* name) {
      const auto read = host_.read(kControl);
      Comparison same;
      for (unsigned i = 0; i < n; ++i) {
        std::uint32_t judged = 0xFFFFFF & ~word::control::kEquState.mask();
        if (i % kChannels == 0) judged &= ~word::control::kCompareChannel.mask();
        same.word(host_.name(i) + " X:+5", read[i] & judged, words[i] & judged);
      }
      b_.report.step(name, same, n, fmt::format("{} X:+5 = ${:06X}", host_.name(0), read[0]));
    };
    judge("control words after I7mn0 to I7mn9");
    b_.report.equal<std::string>("AENA meanwhile", enables(), enables(&on));
    for (unsigned i = 0; i < n; ++i) {
      on[i] = 1 - on[i];
      words[i] ^= word::control::kAena.mask();
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
          {"the scoreboard's filter lets one sample pass", "pulses of 1 SCLK period on all pins", "bits 23..12"},
          run,
          kAServoIc};
}

}  // namespace brick
