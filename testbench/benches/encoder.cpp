// encoder: all channels at once, each with its own decode mode, under random movement with glitches, jumps of both
// lines and turns. Every change of every counter is judged to the tick by testbench/checkers/channel_scoreboard.h,
// which sees the same pins; then the words that a host reads: positions, status, timers, and the fraction of hardware
// 1/T.
#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/encoder_bench.h"

namespace brick {

namespace {
constexpr unsigned kSteps = 400;  // of a random movement
bool knows_errors(unsigned mode) { return (mode < 8 && mode % 4 != 0) || mode == 11 || mode == 15; }
bool counts_pins(unsigned mode) { return mode < 8 || mode == 11 || mode == 15; }
}  // namespace

EncoderBench::EncoderBench(BenchContext& b) : b_(b), host_(b) {
  for (unsigned i = 0; b.negative && i < host_.channels(); ++i) host_.board(i).filter.lets_one_pass = true;
}

void EncoderBench::run() {
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

void EncoderBench::define() {
  host_.define(kStatus, word::kStatus);
  host_.define(kPhase, word::kPhasePosition, true);
  host_.define(kServoWord, word::kServoPosition);
  host_.define(kT1, word::kTimer1);
  host_.define(kT2, word::kTimer2);
  host_.define(kError, word::kStatus, false, word::status::kEncoderError);
  host_.define(kReset, word::kControl, false, word::control::kCounterReset);
  host_.define(kLoss, word::kStatus, false, word::status::kEncoderLoss);
  host_.define(kOutC, word::kOutC, true);
}

void EncoderBench::all(unsigned number, long value) {
  host_.ask(fmt::format("M{},{},100={}", number, host_.channels(), value));
}

void EncoderBench::set_modes(const std::vector<unsigned>& modes) {
  host_.assign(0, modes);
  for (unsigned i = 0; i < modes.size(); ++i) {
    ChannelScoreboard& board = host_.board(i);
    if (board.decoder.mode == 12) board.decoder.clear_timing();  // T1 was an echo
    board.decoder.mode = modes[i];
    board.touch();
  }
}

void EncoderBench::clear_errors() {
  all(kError, 0);
  for (unsigned i = 0; i < host_.channels(); ++i) host_.board(i).decoder.clear_error();
}

// Counts of a decode mode each way.
void EncoderBench::cover_ways(unsigned mode, const std::vector<ChannelScoreboard::Change>& counts) {
  unsigned up = 0, down = 0;
  for (std::size_t n = 1; n < counts.size(); ++n)
    ++(((counts[n].value - counts[n - 1].value) & 0xFFFFFF) == 1 ? up : down);
  b_.report.cover(fmt::format("counts up, I7mn0={}", mode), up);
  b_.report.cover(fmt::format("counts down, I7mn0={}", mode), down);
}

void EncoderBench::random_movement(const std::vector<unsigned>& modes) {
  set_modes(modes);
  clear_errors();
  const Tick start = host_.now() + 100;
  for (unsigned i = 0; i < modes.size(); ++i)
    host_.drive(i, start + host_.pick(200), moves_.random(modes[i], host_.pins(i), kSteps));
  host_.play();
  for (unsigned i = 0; i < modes.size(); ++i) {
    const std::int32_t position = host_.board(i).decoder.counter();
    if (counts_pins(modes[i])) cover_ways(modes[i], host_.board(i).counts);
    const auto d = host_.counts(i);
    const bool enough = counts_pins(modes[i]) ? d.events >= kSteps / 20 : d.events == 0;
    b_.report.step(
        fmt::format("{} I7mn0={}", host_.name(i), modes[i]), d.text.empty() && enough,
        d.text.empty() ? fmt::format("{} counts, each at its tick, position {}", d.events, position) : d.text);
  }
  b_.bus.wait(2 * kServo);
  words("positions, status and T1 of all channels", static_cast<unsigned>(modes.size()));
  const auto erring = std::count_if(modes.begin(), modes.end(), knows_errors);
  b_.report.equal<std::int64_t>("channels with a count error: all modes that know one", errors_, erring);
  clear_errors();
  Comparison now;
  const auto error = host_.read(kError);
  for (unsigned i = 0; i < modes.size(); ++i)
    now.equal(host_.name(i) + " count error", error[i], host_.board(i).decoder.error() ? 1 : 0);
  b_.report.step("count error after a write of 0", now, static_cast<unsigned>(modes.size()), "where the cause stands");
}

// One illegal move at a time: three lines at once, then hall lines that are no state. Pulse and direction knows no
// error.
void EncoderBench::illegal_moves() {
  const std::vector<unsigned> modes{1, 2, 3, 11, 15, 5, 0, 4};
  set_modes({modes.begin(), modes.begin() + static_cast<long>(std::min<std::size_t>(host_.channels(), modes.size()))});
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
  put(kC);
  clear_errors();
  errors("count error of modes 1 2 3 11 15 5 0 4, cleared", "00000000");
  put(kA | kB);
  errors("A, B, C from 001 to 110", "11111100");
  put(kA);
  clear_errors();
  errors("100", "00000000");
  put(0);
  errors("000", "00011000");
  judge_counts("positions meanwhile", host_.channels());
}

void EncoderBench::words(const std::string& name, unsigned channels) {
  const auto status = host_.read(kStatus), phase = host_.read(kPhase), servo = host_.read(kServoWord),
             t1 = host_.read(kT1);
  using namespace word::status;
  constexpr std::uint32_t kJudged = span(kCha, kChc).mask() | kEncoderError.mask() | kDemuxInvalid.mask();
  Comparison same;
  errors_ = 0;
  for (unsigned i = 0; i < channels; ++i) {
    const ChannelScoreboard& board = host_.board(i);
    errors_ += board.decoder.error() ? 1 : 0;
    same.word(host_.name(i) + " status", status[i] & kJudged, board.status(kJudged));
    same.word(host_.name(i) + " X:+1", phase[i], board.decoder.counter());
    const std::uint32_t position = word::servo_position::kPosition.set(0, board.decoder.raw());
    same.word(host_.name(i) + " X:+2", servo[i],
              word::servo_position::kDown.set(position, board.decoder.down() ? 1 : 0));
    if (board.decoder.counts() >= 2 && board.decoder.mode != 12)
      same.word(host_.name(i) + " T1", t1[i],
                word::timer1::kReversed.set(board.decoder.t1(), board.decoder.reversed() ? 1 : 0));
  }
  b_.report.step(name, same, 3 * channels, fmt::format("{} words as the scoreboard", same.made()));
}

void EncoderBench::judge_counts(const std::string& name, unsigned least) {
  Comparison same;
  for (unsigned i = 0; i < host_.channels(); ++i) {
    const auto d = host_.counts(i);
    same.judged(host_.name(i), d.text, static_cast<unsigned>(d.events));
  }
  b_.report.step(name, same, least, fmt::format("{} counts, each at its tick", same.made()));
}

// Control bit 10: to 0 at once, and no count while it stands; a jump leaves no error. What is not 0 before is cleared
// in one step.
void EncoderBench::counter_reset() {
  const auto before = host_.read(kPhase);
  all(kReset, 1);
  const Tick held = host_.now();
  for (unsigned i = 0; i < host_.channels(); ++i) {
    host_.board(i).decoder.hold = true;
    host_.board(i).touch();
    std::vector<ChannelHost::Hold> holds = moves_.even(host_.pins(i), 5, true, 4);
    holds.push_back({static_cast<std::uint16_t>(holds.back().pins ^ (kA | kB)), 5 * host_.period()});
    host_.drive(i, host_.now() + 50, holds);
  }
  host_.play();
  b_.bus.wait(2 * kServo);
  const auto phase = host_.read(kPhase), error = host_.read(kError);
  Comparison same;
  unsigned cleared = 0;
  for (unsigned i = 0; i < host_.channels(); ++i) {
    auto& seen = host_.player().seen[i].counts;
    cleared += before[i] != 0 ? 1 : 0;
    same.equal(host_.name(i) + " changes of the counter", static_cast<std::int64_t>(seen.size()),
               before[i] != 0 ? 1 : 0);
    for (const auto& change : seen) {
      same.equal(host_.name(i) + " counter", change.value, 0);
      same.within(host_.name(i) + " tick of the change", change.tick, 0, held);
    }
    seen.clear();
    same.equal(host_.name(i) + " X:+1", phase[i], 0);
    same.equal(host_.name(i) + " count error", error[i], 0);
  }
  b_.report.step("control bit 10 while A and B move", same, 3 * host_.channels() + 2,
                 fmt::format("{} of {} counters were not 0, each goes there once", cleared, host_.channels()));
  all(kReset, 0);
  for (unsigned i = 0; i < host_.channels(); ++i) {
    host_.board(i).decoder.hold = false;
    host_.drive(i, host_.now() + 50, moves_.even(host_.pins(i), 9, host_.pick(2) != 0, 3));
  }
  host_.play();
  judge_counts("counts again", 9 * host_.channels());
}

// ENC_LOSS: T = U or V = W by two samples behind the filter (servo-ic:5.15); it stays until 0 is written. The filter
// delays all edges alike, so two lines of a pair that turn n SCLK periods one after the other are equal for n
// samples.
void EncoderBench::encoder_loss() {
  constexpr unsigned kPinT = 1u << kT, kPinU = 1u << kU, kPinV = 1u << kV, kPinW = 1u << kW,
                     kLines = kPinT | kPinU | kPinV | kPinW;
  const auto with = [](std::uint16_t pins, unsigned lines) {
    return static_cast<std::uint16_t>((pins & ~kLines) | lines);
  };
  const auto losses = [&](const std::string& name, long expected) {
    const auto read = host_.read(kLoss);
    Comparison same;
    for (unsigned i = 0; i < host_.channels(); ++i) same.equal(host_.name(i) + " ENC_LOSS", read[i], expected);
    b_.report.step(name, same, host_.channels(), fmt::format("{} on all channels", expected));
  };
  for (unsigned i = 0; i < host_.channels(); ++i)
    host_.drive(i, host_.now() + 50, {{with(host_.pins(i), kPinT | kPinW), 1}});
  host_.play();
  all(kLoss, 0);
  losses("encoder loss, complement pairs", 0);
  struct Turn {
    const char* name;
    unsigned early, late;  // lines that turn
  };
  for (const Turn& pair :
       {Turn{"T before U", kPinT, kPinU}, Turn{"W before V", kPinW, kPinV}, Turn{"U before T", kPinU, kPinT}})
    for (const unsigned samples : {1u, 2u}) {
      for (unsigned i = 0; i < host_.channels(); ++i) {
        const unsigned first = host_.pins(i) ^ pair.early, second = first ^ pair.late;
        host_.drive(i, host_.now() + 50 + host_.pick(40),
                    {{static_cast<std::uint16_t>(first), samples * host_.period()},
                     {static_cast<std::uint16_t>(second), 8 * host_.period()}});
      }
      host_.play();
      losses(fmt::format("{} by {} SCLK period{}", pair.name, samples, samples == 1 ? "" : "s"), samples - 1);
      all(kLoss, 0);
    }
  losses("0 written", 0);
}

// covers: CARD-1 CARD-2
Bench encoder_bench() {
  return {"encoder",
          "all decode modes under random movement with glitches and jumps, counters to the tick, timers, hardware 1/T, "
          "MLDT",
          {"the scoreboard's filter lets one sample pass", "servo_ic*.ch? I7mn0=*", "change *, expected"},
          [](BenchContext& b) { EncoderBench(b).run(); },
          kAServoIc};
}

}  // namespace brick
