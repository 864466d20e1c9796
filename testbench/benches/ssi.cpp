// ssi: absolute encoders at all serial inputs of the board, turning all the time, right ones and faulty ones. Every
// edge of the serial clocks and every word that the CPU reads is judged (testbench/checkers/ssi_scoreboard.h), then the
// conversion table that takes these words, and the triggers that come too early. A Geo PMAC is set by I1015 to I1019, a
// Geo Brick LV by its control words.
#include <array>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "systemc/machine/board_family.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/servo_host.h"
#include "testbench/checkers/ssi_scoreboard.h"
#include "testbench/plant/ssi_encoder.h"

namespace brick {
namespace {

using plant::SsiEncoder;
using plant::SsiEncoderParameters;

constexpr unsigned kInputs = 8, kGroup = 4;
constexpr Tick kRest = 2360;  // 20 us

struct Frame {
  Tick trigger = 0;
  std::vector<Tick> edges;
  std::uint64_t held = 0, word = 0;
  bool spoilt = false;
};

// The encoders, and what they see of the controller.
class Encoders : public MotorPeer {
 public:
  explicit Encoders(std::uint64_t seed) : seed_(seed) {}

  void fit(unsigned channel, const SsiEncoderParameters& p) { at_[channel].emplace(p, seed_, ++fitted_); }
  void stand(bool still, Tick now) {
    if (still) stood_ = now;
    still_ = still;
  }
  void begin() {
    for (auto& frames : frames_) frames.clear();
    triggers_.clear();
  }
  // Triggers that edges after `from` up to `to` saw and that began no frame of the channel.
  long refused(unsigned channel, Tick from, Tick to) const {
    long count = 0;
    for (const Tick t : triggers_) count += from < t && t <= to ? 1 : 0;
    for (const Frame& f : frames_[channel]) count -= from < f.trigger && f.trigger <= to ? 1 : 0;
    return count;
  }
  const std::deque<Frame>& frames(unsigned channel) const { return frames_[channel]; }
  const SsiEncoder& encoder(unsigned channel) const { return *at_[channel]; }
  // Positions rise by 7 counts in 128 ticks, each channel from elsewhere.
  std::uint64_t position(unsigned channel, Tick t) const {
    return (seed_ + channel) * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(7 * (still_ ? stood_ : t) / 128);
  }
  void net_moved(Tick t, bool trigger) {
    if (!trigger) return;
    trigger_ = t + 1;  // the first edge that sees it
    triggers_.push_back(trigger_);
  }

  std::uint32_t ics() const override { return 0; }
  std::uint8_t ssi_channels() const override { return 0xFF; }
  void ssi_clocked(Tick tick, std::uint8_t before, std::uint8_t after) override {
    for (unsigned n = 0; n < kInputs; ++n) {
      if (((before ^ after) >> n & 1) == 0 || !at_[n]) continue;
      const bool level = (after >> n & 1) != 0;
      at_[n]->clock(tick, level, position(n, tick));
      auto& frames = frames_[n];
      if (!level && tick - last_[n] > kRest) frames.emplace_back();
      last_[n] = tick;
      if (frames.empty()) continue;  // begun before
      Frame& frame = frames.back();
      if (frame.edges.empty()) frame.trigger = trigger_;  // those that came since were refused
      frame.edges.push_back(tick);
      frame.held = at_[n]->held();
      frame.word = at_[n]->word();
      frame.spoilt = at_[n]->spoilt();
    }
  }
  std::uint8_t ssi_data(Tick now) override {
    unsigned data = 0xFF;
    for (unsigned n = 0; n < kInputs; ++n)
      if (at_[n] && !at_[n]->level(now)) data &= ~(1u << n);
    return static_cast<std::uint8_t>(data);
  }
  Tick next_event() const override { return next_; }
  bool step(Tick now, MotorInputPins&) override {
    next_ = kNever;
    for (auto& encoder : at_) {
      if (!encoder) continue;
      encoder->level(now);
      next_ = std::min(next_, encoder->next_change());
    }
    return false;
  }

 private:
  std::uint64_t seed_;
  std::uint64_t fitted_ = 0;
  std::array<std::optional<SsiEncoder>, kInputs> at_;
  std::array<std::deque<Frame>, kInputs> frames_;
  std::array<Tick, kInputs> last_{};  // edge
  std::vector<Tick> triggers_;
  Tick trigger_ = 0, next_ = 0, stood_ = 0;
  bool still_ = false;
};

class SsiBench {
 public:
  explicit SsiBench(BenchContext& b);
  ~SsiBench();
  SsiBench(const SsiBench&) = delete;
  SsiBench& operator=(const SsiBench&) = delete;
  void run() { geo_ ? run_geo() : run_brick(); }

 private:
  struct Read {
    Tick edge;
    bool high;
    std::uint32_t data;
  };
  BenchReport& report() { return host_.report(); }
  unsigned channels() const { return geo_ ? 2 : kInputs; }
  std::uint32_t position_word(unsigned n) const {
    return geo_ ? regs::ssi_geo::kPosition.address + 0x20 * n : regs::ssi_brick::kPosition.address + 4 * n;
  }
  void run_geo();
  void run_brick();
  void faults();
  void define();
  void set();  // the channels as `setting_` says, from a silent board on
  void silence();
  void judge(const std::string& what, unsigned least_frames);
  void judge_frames(Comparison& frames, unsigned n);
  void judge_reads(Comparison& reads, unsigned n);
  void refused();
  void table();
  void without();
  SsiEncoderParameters matched(unsigned n);
  void fit_all();

  ServoHost host_;
  Encoders encoders_;
  const bool geo_;
  std::array<SsiSetting, kInputs> setting_;
  unsigned clock_ = 0;  // I1015
  bool on_phase_ = false, falling_ = true;
  bool one_shot_ = false;
  std::array<std::vector<Read>, kInputs> reads_;
  std::vector<std::pair<Tick, std::uint32_t>> counts_;  // reads of channel 1's refused triggers
  std::function<void(Tick, const BoardOutputs&, const BoardOutputs&)> outputs_;
  std::function<void(const PortACycle&)> cycle_;
};

SsiBench::SsiBench(BenchContext& b)
    : host_(b, b.seed * 7'919 + 13),
      encoders_(b.seed),
      geo_(b.board.ssi_kind == kSsiGeoPmac),
      outputs_(b.machine.on_outputs),
      cycle_(b.machine.on_bus_cycle) {
  b.machine.on_outputs = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    if (outputs_) outputs_(t, before, after);
    const PinField& net = on_phase_ ? pin::kPhase : pin::kServo;
    if (before.get(net) != after.get(net)) encoders_.net_moved(t, (before.get(net) != 0) == falling_);
  };
  b.machine.on_bus_cycle = [this, &machine = b.machine](const PortACycle& c) {
    if (cycle_) cycle_(c);
    const Tick edge = bus_edge(c, machine);
    if (c.x && !c.write && c.address == (geo_ ? regs::ssi_geo::kRefused : regs::ssi_brick::kRefused).address)
      counts_.emplace_back(edge, c.data);
    if (c.x || c.write || c.on_chip) return;
    for (unsigned n = 0; n < channels(); ++n)
      if (c.address - position_word(n) < (geo_ ? 1u : 2u))
        reads_[n].push_back({edge, c.address != position_word(n), c.data});
  };
  b.machine.attach(encoders_);
}

SsiBench::~SsiBench() {
  Machine& machine = host_.bench().machine;
  machine.detach(encoders_);
  machine.on_outputs = outputs_;
  machine.on_bus_cycle = cycle_;
}

// An encoder that says what the channel is told to read.
SsiEncoderParameters SsiBench::matched(unsigned n) {
  SsiEncoderParameters p;
  p.bits = setting_[n].bits;
  p.gray = setting_[n].gray;
  p.parity = static_cast<SsiEncoderParameters::Parity>(setting_[n].parity);
  if (host_.bench().negative) p.delay = setting_[n].after(setting_[n].period);
  return p;
}

void SsiBench::fit_all() {
  for (unsigned n = 0; n < channels(); ++n) encoders_.fit(n, matched(n));
}

void SsiBench::define() {
  std::vector<std::string> words;
  for (unsigned n = 0; n < channels(); ++n) {
    words.push_back(fmt::format("M{}->Y:${:X},0,24", 100 + n, position_word(n)));
    if (geo_) continue;
    words.push_back(fmt::format("M{}->Y:${:X},0,24", 110 + n, position_word(n) + 1));
    words.push_back(fmt::format("M{}->X:${:X},0,24", 120 + n, position_word(n)));
    words.push_back(fmt::format("M{}->X:${:X},0,24", 130 + n, position_word(n) + 1));
  }
  if (geo_) words.insert(words.end(), {"M130->X:$FF56,0,24", "M131->X:$FF76,0,24"});
  if (!geo_) words.insert(words.end(), {"M140->X:$78B2F,0,24", "M141->X:$78B3F,0,24"});
  host_.say(words);
}

void SsiBench::silence() {
  std::vector<std::string> words;
  if (geo_)
    words = {"I1016=0", "I1018=0"};
  else
    for (unsigned n = 0; n < kInputs; ++n) words.push_back(fmt::format("M{}=0", 120 + n));
  host_.say(words);
  host_.wait(400 * 118);  // longer than the longest frame
}

void SsiBench::set() {
  silence();
  fit_all();
}

void SsiBench::judge_frames(Comparison& frames, unsigned n) {
  const auto& all = encoders_.frames(n);
  for (std::size_t i = 0; i + 1 < all.size(); ++i)  // the last may be under way
    frames.judged(fmt::format("channel {} frame {}", n + 1, i + 1),
                  ssi_clock_difference(setting_[n], all[i].trigger, all[i].edges));
}

// A read shows the last word that was whole an edge before; the high part belongs to the low part before it.
void SsiBench::judge_reads(Comparison& reads, unsigned n) {
  const SsiEncoderParameters& p = encoders_.encoder(n).parameters();
  const auto expected = [&](Tick edge) -> std::optional<SsiResult> {
    const Frame* last = nullptr;
    for (const Frame& f : encoders_.frames(n))
      if (f.edges.size() == 2 * setting_[n].clocks() && f.edges.back() + 1 < edge) last = &f;
    if (last == nullptr) return {};
    SsiSetting setting = setting_[n];
    return ssi_result(setting, last->word, encoders_.encoder(n).length(), p.missing);
  };
  std::optional<SsiResult> held;
  for (const Read& r : reads_[n]) {
    if (!r.high) held = expected(r.edge);
    if (!held) continue;
    const std::uint32_t high = held->position >> 24 | (held->parity_error ? 0x800000u : 0u);
    reads.word(fmt::format("channel {} {} at tick {}", n + 1, r.high ? "B" : "A", r.edge), r.data,
               r.high ? high : held->position);
  }
}

// Frames and reads from here on for some servo periods.
void SsiBench::judge(const std::string& what, unsigned least_frames) {
  encoders_.begin();
  for (auto& reads : reads_) reads.clear();
  host_.wait(3 * 55'000);
  for (int i = 0; i < 2; ++i) {
    host_.ask(geo_ ? "M100 M101" : "M100 M110 M101 M111 M102 M112 M103 M113");
    if (!geo_) host_.ask("M104 M114 M105 M115 M106 M116 M107 M117");
  }
  host_.wait(55'000);
  Comparison frames, reads;
  for (unsigned n = 0; n < channels(); ++n) {
    judge_frames(frames, n);
    judge_reads(reads, n);
  }
  report().step(what + ": clocks", frames, least_frames * channels(), fmt::format("{} frames", frames.made()));
  report().step(what + ": words", reads, 2 * channels(), fmt::format("{} reads", reads.made()));
}

void SsiBench::run_geo() {
  define();
  constexpr const char* kNames[] = {"153.6 kHz", "307.2 kHz", "614.4 kHz", "1.2288 MHz"};
  for (unsigned round = 0; round < 16; ++round) {
    clock_ = round % 4;
    const unsigned length[] = {(round / 4 + clock_) % 4, round / 4};
    const unsigned mode = host_.pick(2);
    for (unsigned n = 0; n < 2; ++n) {
      setting_[n] = {};
      setting_[n].period = 768 >> clock_;
      setting_[n].bits = 12 + 4 * length[n];
      setting_[n].gray = (mode + n) % 2 != 0;
    }
    set();
    host_.say({fmt::format("I1015={} I1017={} I1019={} I1016={} I1018={}", clock_, length[0], length[1],
                           setting_[0].gray ? 3 : 2, setting_[1].gray ? 3 : 2)});
    judge(fmt::format("{}, {} and {} bits", kNames[clock_], setting_[0].bits, setting_[1].bits), 2);
  }
  faults();
  table();
  refused();
}

void SsiBench::run_brick() {
  define();
  for (unsigned round = 0; round < 6; ++round) {
    on_phase_ = round % 2 != 0;
    falling_ = round % 4 < 2;
    std::array<std::uint32_t, 2> timing{};
    for (unsigned g = 0; g < 2; ++g) {
      const unsigned divisor = round == 0 ? 99 : 24 + host_.pick(8), power = round == 0 ? 0 : host_.pick(3),
                     delay = round < 2 ? 0 : host_.pick(6);
      timing[g] = divisor << 16 | power << 12 | (on_phase_ ? 0u : 1u) << 9 | (falling_ ? 1u : 0u) << 8 | delay << 4 | 2;
      for (unsigned n = kGroup * g; n < kGroup * (g + 1); ++n) {
        SsiSetting& s = setting_[n];
        s.cycles = true;
        s.period = static_cast<std::int64_t>(divisor + 1) << power;
        s.bits = 12 + (round * kInputs + n) % 21;
        s.gray = host_.pick(2) != 0;
        s.parity = host_.pick(3);
        s.delay = delay;
      }
    }
    set();
    std::vector<std::string> words{fmt::format("M140={}", timing[0]), fmt::format("M141={}", timing[1])};
    for (unsigned n = 0; n < kInputs; ++n)
      words.push_back(fmt::format(
          "M{}={}", 120 + n, setting_[n].parity << 14 | 0x1400 | (setting_[n].gray ? 0x800u : 0u) | setting_[n].bits));
    host_.say(words);
    judge(fmt::format("{} {}, from {} bits on", on_phase_ ? "PHASE" : "SERVO", falling_ ? "falls" : "rises",
                      setting_[0].bits),
          2);
  }
  faults();
  table();
  refused();
}

// Encoders that are not what the channels are told.
void SsiBench::faults() {
  const auto with = [this](const std::string& what,
                           const std::function<void(SsiEncoderParameters&, unsigned)>& change) {
    for (unsigned n = 0; n < channels(); ++n) {
      SsiEncoderParameters p = matched(n);
      change(p, n);
      encoders_.fit(n, p);
    }
    host_.wait(2 * 55'000);  // a frame that was under way is over, the next ones are theirs
    judge(what, 2);
  };
  with("too few bits", [](SsiEncoderParameters& p, unsigned) { p.bits -= 3; });
  with("too many bits", [](SsiEncoderParameters& p, unsigned) { p.bits = std::min(32u, p.bits + 4); });
  with("no encoder", [](SsiEncoderParameters& p, unsigned) { p.missing = true; });
  with("bit errors", [](SsiEncoderParameters& p, unsigned) { p.error_every = 2; });
  with("late line",
       [this](SsiEncoderParameters& p, unsigned n) { p.delay = setting_[n].after(setting_[n].period) - 4; });
  with("monoflop longer than the pause", [](SsiEncoderParameters& p, unsigned) { p.monoflop = 70'000; });
}

// A word at rest through the methods of the table: the lowest bit at bit 5 or 0 (motion:2.2).
void SsiBench::table() {
  fit_all();
  encoders_.stand(true, host_.now());
  host_.wait(2 * 55'000);
  const std::uint32_t source = position_word(0);
  const std::uint32_t bits = std::min(setting_[0].bits, 24u), width = bits << 12;
  host_.say({fmt::format("I8000=${:X} I8001=${:X}", 0x200000 | source, width),
             fmt::format("I8002=${:X} I8003=${:X} I8004=$7FFFFF", 0x380000 | source, width),
             fmt::format("I8005=${:X} I8006=${:X}", 0x680000 | source, width),
             fmt::format("I8007=${:X} I8008=${:X} I8009=$7FFFFF I8010=0", 0x700000 | source, width),
             "M150->X:$3502,0,24 M151->X:$3505,0,24 M152->X:$3507,0,24 M153->X:$350A,0,24"});
  host_.wait(4 * 55'000);
  const std::uint32_t position =
      static_cast<std::uint32_t>(encoders_.encoder(0).held() & ((std::uint64_t{1} << bits) - 1));
  const std::uint32_t five = position << 5 & 0xFFFFFF;
  const std::vector<long> results = host_.numbers("M150 M151 M152 M153");
  const std::array<std::uint32_t, 4> expected{five, position, position, five};
  for (std::size_t i = 0; i < 4; ++i)
    report().equal(fmt::format("conversion table, method ${}", i < 2 ? i + 2 : i + 4),
                   results.size() == 4 ? results[i] : -1L, static_cast<long>(expected[i]));
  encoders_.stand(false, 0);
}

// SERVO with every phase period, and a serial clock that is too slow for it: of the triggers between two looks at the
// counter those count that began no frame.
void SsiBench::refused() {
  silence();
  on_phase_ = false, falling_ = true;
  host_.say({fmt::format("I{}=0", host_.bench().clock_variable(2))});
  for (unsigned g = 0; g < (geo_ ? 1u : 2u); ++g)
    if (!geo_) host_.say({fmt::format("M{}=${:X}", 140 + g, 0xC72302)});  // 800 cycles a bit
  encoders_.begin();
  counts_.clear();
  if (geo_)
    host_.say({"I1015=0 I1017=3 I1019=3 I1016=2 I1018=2"});
  else
    host_.say({"M120=$1418 M123=$1420"});
  Comparison counts;
  for (int i = 0; i < 6; ++i) {
    host_.wait(90'000);
    host_.ask("M130");
  }
  long all = 0;
  for (std::size_t i = 1; i < counts_.size(); ++i) {
    const long expected = encoders_.refused(0, counts_[i - 1].first - 1, counts_[i].first - 1);
    counts.equal(fmt::format("look {}", i), (counts_[i].second - counts_[i - 1].second) & 0xFF, expected & 0xFF);
    all += expected;
  }
  report().step("triggers that came too early are counted", counts, 5, fmt::format("{} of them", all));
  report().step("some did", all >= 10, fmt::format("{}, expected 10 or more", all));
}

}  // namespace

Bench ssi_bench() {
  return {"ssi",
          "absolute encoders at the serial inputs: every clock edge and word, right and faulty encoders, table",
          {"the encoders' lines are a serial period late", "*: words", "expected"},
          [](BenchContext& b) { SsiBench(b).run(); },
          kSerialInputs};
}

}  // namespace brick
