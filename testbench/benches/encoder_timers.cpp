// encoder, the timers: T1 and T2 at SERVO, pulses of the channel's own PFM (I7mn0 = 8), MLDT (12) and the fraction of
// hardware 1/T. Each value is exact: what the sampling decides is in the expected value.
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/encoder_bench.h"

namespace brick {

namespace {
constexpr regs::Field kFraction = regs::servo_channel_fine::timer2::kServo;  // of Y:+1 with hardware 1/T
constexpr Tick kDivision = 20 * kTicksPerRef;
}  // namespace

Tick EncoderBench::latched(unsigned i, Tick fall) const { return fall + host_.behind(i / kChannels); }

void EncoderBench::timers() {
  std::vector<long> spacing;
  for (unsigned i = 0; i < host_.channels(); ++i) {
    spacing.push_back(20 + host_.pick(1000));
    host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 3, i % 2 == 0, spacing[i]));
  }
  host_.play();
  b_.bus.wait(kServo);
  const auto t1 = host_.read(kT1), t2 = host_.read(kT2);
  Comparison same;
  for (unsigned i = 0; i < host_.channels(); ++i) {
    const Tick servo = host_.last_read(i, word::kTimer2).servo;
    same.equal(host_.name(i) + " T1", t1[i], spacing[i]);
    same.equal(host_.name(i) + " T2", t2[i], host_.board(i).t2(latched(i, servo)));
  }
  b_.report.step("T1 = spacing, T2 = SCLK periods from the count to SERVO", same, 2 * host_.channels(),
                 fmt::format("{}: {} and {}", host_.name(0), t1[0], t2[0]));
  for (unsigned i = 0; i < host_.channels(); ++i)
    host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 1, i % 2 != 0, 4));
  host_.play();
  b_.bus.wait(2 * kServo);
  const auto turned = host_.read(kT1);
  Comparison reversed;
  for (unsigned i = 0; i < host_.channels(); ++i)
    reversed.equal(host_.name(i), word::timer1::kReversed.get(static_cast<std::uint32_t>(turned[i])), 1);
  b_.report.step("bit 23 of Y:+0 after a turn", reversed, host_.channels(), "1 on all channels");
  words("the same by the scoreboard", host_.channels());
  judge_counts("positions until here", 4 * host_.channels());
}

// I7mn0 = 8: the counter follows the channel's own pulses. PFM_CLK is SCLK, c = 2^24 / n gives a pulse every n.
void EncoderBench::own_pulses() {
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
  Comparison same;
  for (unsigned i = 0; i < host_.channels(); ++i) {
    const auto& [counts, equs, pulses] = host_.player().seen[i];
    std::int64_t position = host_.board(i).decoder.counter();
    same.within(host_.name(i) + " pulses", static_cast<std::int64_t>(pulses.size()), 20, kNever);
    same.equal(host_.name(i) + " counts", static_cast<std::int64_t>(counts.size()),
               static_cast<std::int64_t>(pulses.size()));
    for (std::size_t k = 0; k < std::min(counts.size(), pulses.size()); ++k) {
      position += pulses[k].value;
      same.equal(host_.name(i) + " position", counts[k].value, position);
      same.equal(host_.name(i) + " ticks from pulse to count", counts[k].tick - pulses[k].tick, host_.period());
      if (k > 0)
        same.equal(host_.name(i) + " ticks between pulses", pulses[k].tick - pulses[k - 1].tick,
                   every[i] * host_.period());
    }
  }
  b_.report.step("I7mn0=8: each own pulse counts, with its sign", same, 60 * host_.channels(),
                 fmt::format("{} comparisons", same.made()));
  host_.play();
  for (unsigned i = 0; i < host_.channels(); ++i) host_.counts(i);
}

// I7mn0 = 12: T1 counts from the own pulse to the echo on A (servo-ic:5.6). Let the pulse be on SCLK edge 0 and n the
// first edge that samples the echo: its pin changes kSync ticks before it or earlier. The pulse is taken with edge 1,
// so T2 is k - 1 from edge k on. Samples n and n + 1 pass the filter, edge n + 2 decodes and copies what T2 has been
// since edge n + 1: T1 = n, exactly.
void EncoderBench::mldt() {
  set_modes(std::vector<unsigned>(host_.channels(), 12));
  for (unsigned i = 0; i < host_.channels(); ++i)
    host_.drive(i, host_.now() + 50, {{static_cast<std::uint16_t>(host_.pins(i) & ~kA), 1}});
  host_.play();
  const Tick sclk = host_.period();
  std::vector<Tick> delay(host_.channels());  // from the pulse to the echo, ticks
  host_.player().on_pulse = [&](Tick tick, unsigned i) {
    const auto low = static_cast<std::uint16_t>(host_.pins(i) & ~kA);
    host_.player().add({tick + delay[i], i, static_cast<std::uint16_t>(low | kA)});
    host_.player().add({tick + delay[i] + 40 * sclk, i, low});
  };
  all(kOutC, (1 << 24) / 512);
  Comparison same;
  for (const Tick early : {ChannelScoreboard::kSync, ChannelScoreboard::kSync - 1, Tick{0}}) {
    // Echoes just in time for a sample, one tick late for it, and with SCLK: late by the synchroniser.
    for (Tick& d : delay) d = (60 + host_.pick(300)) * sclk - early;
    b_.bus.wait(2 * kServo + 1024 * sclk);
    const auto t1 = host_.read(kT1);
    for (unsigned i = 0; i < host_.channels(); ++i) {
      const Tick sample = (delay[i] + ChannelScoreboard::kSync + sclk - 1) / sclk;
      same.equal(fmt::format("{} T1, echo after {} ticks", host_.name(i), delay[i]), t1[i], sample);
    }
  }
  b_.report.step("I7mn0=12: T1 is the delay of the echo", same, 3 * host_.channels(),
                 fmt::format("{} echoes, to the SCLK period", same.made()));
  all(kOutC, 0);
  b_.bus.wait(1024 * sclk);
  host_.player().on_pulse = nullptr;
  for (auto& seen : host_.player().seen) seen.clear();
  for (unsigned i = 0; i < host_.channels(); ++i) host_.board(i).decoder.clear_timing();
}

// Hardware 1/T: bits 23..12 of Y:+1 are e = floor(4096 T2 / T1) at SERVO, 4095 - e going down, at most 4095; 0 after
// a turn. The estimate is one clk_ref older than the timers, and after a count a division of 13 clk_ref and the SCLK
// periods that it missed come first (servo-ic:5.7).
void EncoderBench::fraction() {
  host_.assign(6, std::vector<unsigned>(host_.channels(), 0));
  set_modes(std::vector<unsigned>(host_.channels(), 3));
  host_.assign(9, std::vector<unsigned>(host_.channels(), 1));
  constexpr unsigned kEven = 80;  // 76 of them take 3.8 ms or more: eight servo periods, one read or more in each
  const long spacing = (6000 + host_.pick(6000)) / static_cast<long>(host_.period());
  const Tick start = host_.now() + 100;
  for (unsigned i = 0; i < host_.channels(); ++i)
    host_.drive(i, start, moves_.even(host_.pins(i), kEven, i % 2 == 0, spacing));
  Comparison same;
  while (host_.now() < start + (kEven - 2) * spacing * host_.period()) {
    b_.bus.wait(host_.pick(10'000));
    const unsigned i = host_.pick(host_.channels());
    host_.ask(fmt::format("M{}", kT2 + 100 * i));
    const auto read = host_.last_read(i, word::kTimer2);
    host_.board(i).advance(host_.now());
    const long t2 = since_count(i, latched(i, read.servo) - kTicksPerRef), e = std::min(4095L, 4096 * t2 / spacing);
    if (read.servo < start + 4 * spacing * host_.period()) continue;     // the timers still know the time before
    if (t2 * host_.period() < kDivision || t2 == spacing - 1) continue;  // after and at a count
    same.equal(fmt::format("{} T2={} T1={} fraction", host_.name(i), t2, spacing), kFraction.get(read.data),
               i % 2 == 0 ? e : 4095 - e);
  }
  b_.report.step("I7mn9=1: fraction at SERVO", same, 6, fmt::format("{} reads", same.made()));
  host_.play();
  b_.bus.wait(std::max<Tick>(spacing * host_.period(), kServo) + kServo);
  rest("at rest: full cell", 4095, 0);
  for (unsigned i = 0; i < host_.channels(); ++i)
    host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 1, i % 2 != 0, 5));
  host_.play();
  b_.bus.wait(2 * kServo);
  rest("after a turn: start of the new cell", 4095, 0);
  judge_counts("counts with hardware 1/T", kEven * host_.channels());
  host_.assign(9, std::vector<unsigned>(host_.channels(), 0));
}

// Even channels went up and odd ones down; after a turn even ones enter their cell from above, odd ones from below.
void EncoderBench::rest(const char* name, long even_channels, long odd_channels) {
  const auto words = host_.read(kT2);
  Comparison same;
  for (unsigned i = 0; i < host_.channels(); ++i)
    same.equal(host_.name(i) + " fraction", kFraction.get(static_cast<std::uint32_t>(words[i])),
               i % 2 == 0 ? even_channels : odd_channels);
  b_.report.step(name, same, host_.channels(),
                 fmt::format("{} where it went up before, {} else", even_channels, odd_channels));
}

long EncoderBench::since_count(unsigned i, Tick tick) {
  const auto& counts = host_.player().seen[i].counts;
  const auto next = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.tick > tick; });
  return next == counts.begin() ? 0 : static_cast<long>((tick - std::prev(next)->tick) / host_.period());
}

}  // namespace brick
