// serial-dac-adc: OUT A and B of all channels through serial DACs, and converters that send random words into ADC A and
// B. Lines, clocks and strobes are watched edge by edge; every stream of every PHASE period is judged
// (testbench/checkers/serial_scoreboard.h), and every read of an ADC word by the CPU, wherever it falls between two
// conversions.
#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "systemc/core/clock_delays.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/output_host.h"
#include "testbench/checkers/serial_scoreboard.h"

namespace brick {
namespace {

constexpr unsigned kDacs = 2 * kChannels;  // of an IC: A of channels 1..4, then B; ADCs likewise
constexpr Tick kNear = 20;                 // of an access to an edge of PHASE: both sides are right
constexpr std::size_t kLeastStreams = 3;   // that a step must have seen

std::string few(const SerialRecord& record) {
  return fmt::format("{} streams, expected {} or more", record.streams.size(), kLeastStreams);
}

// The converters of one IC: 24 random bits a stream, a bit stands from one falling edge of the clock to the next.
class Converters : public MotorPeer {
 public:
  struct Sent {
    Tick tick;  // of the last falling edge
    std::array<std::uint32_t, kDacs> words;
  };
  Converters(unsigned ic, std::uint64_t seed, unsigned late) : random_(seed * 92'821 + ic), ic_(ic), late_(late) {}

  std::uint32_t ics() const override { return 1u << ic_; }
  MotorOutputs stops(unsigned ic) const override {
    MotorOutputs pins;
    if (ic == ic_) pins.set(motor_pin::kAdcClk, 0, 1);
    return pins;
  }
  Tick next_event() const override { return kNever; }
  void changed(Tick tick, unsigned, const MotorOutputs& before, const MotorOutputs& after) override {
    const bool clock = after.get(motor_pin::kAdcClk, 0) != 0;
    if (clock == (before.get(motor_pin::kAdcClk, 0) != 0)) return;
    if (clock && tick - edge_ > kPause) {  // the first of a stream
      known_ = known_ && bit_ == 0;
      bit_ = 0;
    }
    edge_ = tick;
    if (clock || ++bit_ < 24) return;
    if (known_) sent.push_back({tick, words_});
    bit_ = 0;
    known_ = true;
    for (auto& w : words_) w = static_cast<std::uint32_t>(random_()) & 0xFFFFFF;
  }
  bool step(Tick, MotorInputPins& inputs) override {
    MotorInputs& in = inputs[ic_];
    in.adc_a = in.adc_b = 0;
    for (unsigned n = 0; n < kDacs; ++n) {
      const unsigned bit = words_[n] >> late_ >> (23 - bit_) & 1;
      (n < kChannels ? in.adc_a : in.adc_b) |= static_cast<std::uint8_t>(bit << n % kChannels);
    }
    return true;
  }

  std::vector<Sent> sent;  // whole streams

 private:
  static constexpr Tick kPause = 400;  // longer than the longest clock period

  std::mt19937_64 random_;
  unsigned ic_, late_, bit_ = 0;
  bool known_ = false;  // since a whole stream
  Tick edge_ = 0;
  std::array<std::uint32_t, kDacs> words_{};
};

struct Setting {
  unsigned dac = 3, adc = 4;  // clock dividers
  std::uint32_t dac_strobe = 0x7FFFC0, adc_strobe = 0xFFFFFE;
};

class Serial {
 public:
  explicit Serial(BenchContext& b);
  ~Serial() {
    for (auto& c : converters_) host_.bench().machine.detach(*c);
  }
  Serial(const Serial&) = delete;
  Serial& operator=(const Serial&) = delete;

  void factory();
  void other_words();
  void round(unsigned number);

 private:
  struct Command {
    Tick tick;
    std::uint32_t value;
  };
  BenchReport& report() { return host_.report(); }
  std::string name(unsigned place, unsigned n) const {
    return fmt::format("{} {}", host_.name(kChannels * place + n % kChannels), n < kChannels ? "A" : "B");
  }
  void configure(const std::array<Setting, 2>& settings, unsigned phase_divider, unsigned servo_divider);
  void begin();
  void command();
  void read();
  void judge(const std::string& what);
  void judge_dac(const std::string& what, unsigned place, const std::vector<Tick>& rises);
  void judge_adc(const std::string& what, unsigned place, const std::vector<Tick>& rises);
  void judge_reads(const std::string& what, unsigned place);

  OutputHost host_;
  std::vector<std::unique_ptr<Converters>> converters_;
  std::array<Setting, 2> settings_;
  std::vector<unsigned> inverted_;
  std::vector<std::vector<Command>> commands_;  // since begin(), of DAC n of an IC
  std::vector<long> answers_;
  Tick begin_ = 0;
};

Serial::Serial(BenchContext& b) : host_(b), inverted_(host_.channels()), commands_(kDacs * host_.places()) {
  for (unsigned i = 0; i < host_.places(); ++i) {
    converters_.push_back(std::make_unique<Converters>(host_.ic(i), b.seed, b.negative ? 1 : 0));
    b.machine.attach(*converters_.back());
  }
  host_.define(102, word::kOutA);
  host_.define(104, word::kOutB);
  host_.define(105, word::kAdcA);
  host_.define(106, word::kAdcB);
  std::vector<std::string> words;
  for (unsigned i = 0; i < host_.channels(); ++i) words.push_back(fmt::format("I{}=1", host_.i_channel(i, 6)));
  host_.say(words);
}

void Serial::configure(const std::array<Setting, 2>& settings, unsigned phase_divider, unsigned servo_divider) {
  std::vector<std::string> words{fmt::format("I{}={}", host_.bench().clock_variable(1), phase_divider),
                                 fmt::format("I{}={}", host_.bench().clock_variable(2), servo_divider)};
  for (unsigned i = 0; i < host_.places(); ++i) {
    const Setting& s = settings[i];
    words.push_back(fmt::format("I{}={}", host_.i_global(i, 3), 2 + 8 * 2 + 64 * s.dac + 512 * s.adc));
    words.push_back(fmt::format("I{}=${:06X}", host_.i_global(i, 5), s.dac_strobe));
    words.push_back(fmt::format("I{}=${:06X}", host_.i_global(i, 6), s.adc_strobe));
  }
  for (unsigned i = 0; i < host_.channels(); ++i)
    words.push_back(fmt::format("I{}={}", host_.i_channel(i, 7), inverted_[i]));
  host_.say(words);
  settings_ = settings;
  host_.wait(2 * (phase_divider + 1) * 13'057 + 13'057);
}

void Serial::begin() {
  for (auto& list : commands_) list = {list.empty() ? Command{0, 0} : Command{0, list.back().value}};
  answers_.clear();
  host_.forget();
  begin_ = host_.now();
}

// Random words, all 24 bits, into every OUT A and B.
void Serial::command() {
  std::vector<std::string> words;
  for (unsigned place = 0; place < host_.places(); ++place)
    for (unsigned n = 0; n < kDacs; ++n) {
      commands_[kDacs * place + n].push_back({0, host_.pick(1u << 24)});
      words.push_back(fmt::format("M{}={}", 100 * (kChannels * place + n % kChannels + 1) + (n < kChannels ? 2 : 4),
                                  commands_[kDacs * place + n].back().value));
    }
  host_.say(words);
  for (unsigned i = 0; i < commands_.size(); ++i) {
    const unsigned n = i % kDacs;
    const Tick at = host_.written(i / kDacs * kChannels + n % kChannels, n < kChannels ? word::kOutA : word::kOutB);
    if (at < 0) report().fail(name(i / kDacs, n), "the command never came to its word");
    commands_[i].back().tick = at;
  }
}

void Serial::read() {
  for (const unsigned number : {105u, 106u})
    for (const long value : host_.numbers(fmt::format("M{},{},100", number, host_.channels())))
      answers_.push_back(value);
}

void Serial::judge_dac(const std::string& what, unsigned place, const std::vector<Tick>& rises) {
  const Setting& setting = settings_[place];
  std::vector<SerialLevel> levels;
  for (const auto& c : host_.changes(place)) {
    unsigned data = 0;
    for (unsigned n = 0; n < kDacs; ++n)
      data |= c.pins.get(n < kChannels ? motor_pin::kDac : motor_pin::kDacB, n % kChannels) << n;
    levels.push_back({c.tick, c.pins.get(motor_pin::kDacClk, 0) != 0, c.pins.get(motor_pin::kDacStrobe, 0) != 0, data});
  }
  const SerialRecord record = serial_streams(levels, rises, kTicksPerRef << setting.dac, kDacs);
  std::string error = record.error;
  const unsigned bits = dac_strobe_bits(setting.dac_strobe);
  const std::uint32_t latched = bits == 0 ? 0 : (1u << bits) - 1;
  for (const SerialStream& s : record.streams) {
    if (!error.empty()) break;
    if (s.strobe != setting.dac_strobe)
      error = fmt::format("strobe ${:06X}, expected ${:06X}", s.strobe, setting.dac_strobe);
    for (unsigned n = 0; n < kDacs && error.empty(); ++n) {
      // A command that comes while the stream begins may be in it or not.
      const bool invert = (inverted_[kChannels * place + n % kChannels] & 1) != 0;
      bool same = false;
      std::uint32_t expected = 0;
      const auto& list = commands_[kDacs * place + n];
      for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].tick > s.first + kNear || (i + 1 < list.size() && list[i + 1].tick < s.phase - kNear)) continue;
        expected = dac_stream(list[i].value, invert);
        const bool rest = invert || (s.data[n] & ~kDacBits) == 0;
        const bool latch =
            bits == 0 || (s.received.size() == kDacs && (s.received[n] & latched) == expected >> (24 - bits));
        same = same || ((s.data[n] & kDacBits) == expected && rest && latch);
      }
      if (!same)
        error =
            fmt::format("{}: bits ${:06X}, a DAC of {} bits has ${:X}, expected ${:06X} (PHASE at {})", name(place, n),
                        s.data[n], bits, s.received.empty() ? 0 : s.received[n] & latched, expected, s.phase);
    }
  }
  const Tick high = record.streams.empty() ? 0 : record.streams.front().strobe_high;
  if (error.empty() && bits != 0 && high != (bits - 1) * (kTicksPerRef << setting.dac))
    error = fmt::format("strobe high for {} ticks, expected {}", high, (bits - 1) * (kTicksPerRef << setting.dac));
  if (error.empty() && record.streams.size() < kLeastStreams) error = few(record);
  report().step(fmt::format("{}: DAC, I{}=${:06X}, a bit {} ticks", what, host_.i_global(place, 5), setting.dac_strobe,
                            kTicksPerRef << setting.dac),
                error.empty(),
                error.empty()
                    ? fmt::format("{} streams of {} DACs; {}", record.streams.size(), kDacs,
                                  bits == 0 ? "no latch edge"
                                            : fmt::format("{} bits latched, the last ${:X} in {}", bits,
                                                          record.streams.back().received[0] & latched, name(place, 0)))
                    : error);
}

void Serial::judge_adc(const std::string& what, unsigned place, const std::vector<Tick>& rises) {
  const Setting& setting = settings_[place];
  std::vector<SerialLevel> levels;
  for (const auto& c : host_.changes(place))
    levels.push_back({c.tick, c.pins.get(motor_pin::kAdcClk, 0) != 0, c.pins.get(motor_pin::kAdcStrobe, 0) != 0, 0});
  const SerialRecord record = serial_streams(levels, rises, kTicksPerRef << setting.adc, 0);
  std::string error = record.error;
  for (const SerialStream& s : record.streams)
    if (error.empty() && s.strobe != setting.adc_strobe)
      error = fmt::format("strobe ${:06X}, expected ${:06X}", s.strobe, setting.adc_strobe);
  if (error.empty() && record.streams.size() < kLeastStreams) error = few(record);
  report().step(fmt::format("{}: ADC strobe, I{}=${:06X}, a bit {} ticks", what, host_.i_global(place, 6),
                            setting.adc_strobe, kTicksPerRef << setting.adc),
                error.empty(),
                error.empty()
                    ? fmt::format("{} streams, the last ${:06X}", record.streams.size(), record.streams.back().strobe)
                    : error);
}

// Every read of Y:+5 and Y:+6: the stream that had ended when PHASE fell last.
void Serial::judge_reads(const std::string& what, unsigned place) {
  std::string error;
  unsigned count = 0;
  std::uint32_t last = 0;
  for (const auto& a : host_.accesses()) {
    if (a.write || a.x) continue;
    unsigned n = 0;
    while (n < kDacs &&
           a.address != host_.address(kChannels * place + n % kChannels, n < kChannels ? word::kAdcA : word::kAdcB))
      ++n;
    if (n == kDacs) continue;
    bool same = false;
    std::uint32_t expected = 0;
    for (const Tick at : {a.tick - kNear, a.tick + kNear}) {  // an access beside the edge sees either
      Tick fall = -1;
      for (const auto& e : host_.phase())
        if (!e.high && e.tick <= at) fall = e.tick;
      const auto& sent = converters_[place]->sent;
      const auto next =
          std::find_if(sent.begin(), sent.end(), [fall](const Converters::Sent& s) { return s.tick > fall; });
      if (fall < 0 || next == sent.begin()) continue;
      expected = adc_word(std::prev(next)->words[n]);
      same = same || a.data == expected;
    }
    if (!same && error.empty())
      error = fmt::format("{} reads ${:06X} at tick {}, expected ${:06X}", name(place, n), a.data, a.tick, expected);
    ++count;
    last = a.data;
  }
  if (error.empty() && count < kDacs) error = fmt::format("{} reads, expected {} or more", count, kDacs);
  report().step(fmt::format("{}: {} ADC words read", what, servo_ic_scope(host_.ic(place))), error.empty(),
                error.empty() ? fmt::format("{} of random 18 bits, the last ${:06X}", count, last) : error);
}

void Serial::judge(const std::string& what) {
  std::vector<Tick> rises;
  for (const auto& e : host_.phase())
    if (e.high && e.tick > begin_ + kNear) rises.push_back(e.tick - kNetDelay);
  for (unsigned place = 0; place < host_.places(); ++place) {
    judge_dac(what, place, rises);
    judge_adc(what, place, rises);
    judge_reads(what, place);
  }
  // What the host was told is what the CPU read.
  std::vector<long> read;
  for (const regs::Register& adc : {word::kAdcA, word::kAdcB})
    for (const auto& a : host_.accesses())
      for (unsigned i = 0; i < host_.channels(); ++i)
        if (!a.write && !a.x && a.address == host_.address(i, adc)) read.push_back(static_cast<long>(a.data));
  std::sort(read.begin(), read.end());
  std::sort(answers_.begin(), answers_.end());
  report().step(what + ": answers to the host", answers_ == read && read.size() >= 2 * host_.channels(),
                fmt::format("{} numbers", answers_.size()));
}

// servo-ic:14/15 and servo-ic:14/5; the Geo Brick LV's amplifier command (servo-ic:14/14) on one IC.
void Serial::factory() {
  configure({Setting{}, Setting{3, 4, 0x7FFFC0, 0xF84DFE}}, 0, 3);
  begin();
  command();
  host_.wait(4 * 13'057);
  read();
  command();
  host_.wait(3 * 13'057);
  judge("factory clocks");
}

// 16-bit DACs; the second IC as a drive has it: ADC_CLK 4.9152 MHz, data inverted.
void Serial::other_words() {
  for (unsigned i = 0; i < host_.channels(); ++i) inverted_[i] = i % 2;
  configure({Setting{3, 4, 0x7FFF00, 0xF84DFE}, Setting{2, 3, 0x7FFF00, 0xF8CDFE}}, 0, 3);
  begin();
  command();
  host_.wait(4 * 13'057);
  read();
  judge("16-bit DACs");
}

void Serial::round(unsigned number) {
  for (auto& i : inverted_) i = host_.pick(4);
  // 24 bits in a PHASE period, or in half of one: with the slowest clocks that of 2 x 13057 ticks.
  const unsigned slow = host_.pick(2);
  std::array<Setting, 2> settings;
  for (Setting& s : settings) {
    s = {host_.pick(slow != 0 ? 8 : 7), host_.pick(slow != 0 ? 8 : 7), host_.pick(1u << 24), host_.pick(1u << 24)};
    const unsigned ones = 1 + host_.pick(17);
    if (host_.pick(3) != 0) s.dac_strobe = ((1u << ones) - 1) << (23 - ones);
  }
  configure(settings, slow != 0 ? 1 : 0, slow != 0 ? 1 : 3);
  begin();
  command();
  host_.wait(host_.pick(3 * 13'057));
  read();
  host_.wait(host_.pick(3 * 13'057));
  read();
  judge(fmt::format("round {}", number));
}

void run(BenchContext& b) {
  Serial serial(b);
  serial.factory();
  serial.other_words();
  for (unsigned i = 1; i <= 3; ++i) serial.round(i);
}

}  // namespace

// covers: CARD-1 CARD-2
Bench serial_dac_adc_bench() {
  return {"serial-dac-adc",
          "words of 16 serial DACs and 16 serial ADCs with other clocks and strobe words, every stream of every PHASE "
          "period",
          {"the converters send one header bit more", "factory clocks: servo_ic* ADC words read", "reads $"},
          run,
          kAServoIc};
}

}  // namespace brick
