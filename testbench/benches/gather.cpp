// gather: data gathering into user memory and the dual-ported RAM, judged by the falls of SERVO that the bench counts
// at the pin, by the servo counter among the sources, and by a word whose two halves a PLC keeps alike. The rules are
// those of host-bus:6.8; nothing here knows how samples are taken.
#include <random>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"
#include "testbench/benches/benches.h"
#include "testbench/host/dpram_port.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = ns_to_ticks(1'000'000);
constexpr unsigned kItems = 90, kTaken = 60;  // of the buffer in the RAM, 30 samples; samples that the host takes

struct Sample {
  std::uint32_t count;      // X:$0
  std::uint32_t low, high;  // halves of D:$20
};

class GatherBench {
 public:
  explicit GatherBench(BenchContext& bench) : b_(bench), ram_(bench.bus), random_(bench.seed * 13 + 5) {
    b_.bus.watch(select_pins(pin::kServo), [this](Tick, const BoardOutputs& before, const BoardOutputs& after) {
      falls_ += before.get(pin::kServo) != 0 && after.get(pin::kServo) == 0;
    });
  }
  ~GatherBench() { b_.bus.watch({}, nullptr); }
  GatherBench(const GatherBench&) = delete;
  GatherBench& operator=(const GatherBench&) = delete;
  void run();

 private:
  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }
  std::uint32_t item(unsigned place) {
    const std::uint32_t at = DPRAM_OPEN + 4 * place;
    return ram_.read(at) | static_cast<std::uint32_t>(ram_.read(at + 2)) << 16;
  }
  void begin(unsigned mode, unsigned period, const std::string& size);
  void judge(const std::string& name, const std::vector<Sample>& samples, unsigned period, unsigned least);
  void memory(unsigned period);
  void ring(unsigned period);
  void ends();

  BenchContext& b_;
  BusDpram ram_;
  std::mt19937_64 random_;
  unsigned falls_ = 0;
};

// Two sources: the servo counter and a long word, three words in all.
void GatherBench::begin(unsigned mode, unsigned period, const std::string& size) {
  b_.expect("DELETE GATHER", "");
  b_.expect(fmt::format("I5000={} I5001=$400000 I5002=$800020 I5050=3 I5049={}", mode, period), "");
  b_.expect("DEFINE GATHER " + size, "");
}

// The counter goes on by the period, the halves are alike, and go on by the period too: PLC 0 runs once a servo
// interrupt.
void GatherBench::judge(const std::string& name, const std::vector<Sample>& samples, unsigned period, unsigned least) {
  const unsigned told = b_.negative ? period + 1 : period;
  Comparison compared;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    compared.equal(fmt::format("sample {}, halves", i), samples[i].low, samples[i].high);
    if (i == 0) continue;
    compared.equal(fmt::format("sample {}, servo interrupts since the last", i),
                   samples[i].count - samples[i - 1].count, told);
    compared.equal(fmt::format("sample {}, scans of the PLC since the last", i), samples[i].low - samples[i - 1].low,
                   period);
  }
  b_.report.step(name, compared, 3 * least - 2, fmt::format("{} samples", samples.size()));
}

void GatherBench::memory(unsigned period) {
  begin(0, period, "2000");
  const unsigned before = falls_;
  b_.expect("GATHER", "");
  b_.bus.wait(period * 10 * kMillisecond + pick(300'000));  // 22 samples of 442 us
  b_.expect("ENDGATHER", "");
  const unsigned passed = falls_ - before;
  const Reply list = b_.link.command("LIST GATHER");
  std::vector<Sample> samples;
  for (std::size_t i = 0; i + 1 < list.lines.size(); i += 2) {
    const auto half = [&](std::size_t line, std::size_t at) {
      return static_cast<std::uint32_t>(std::stoul(list.lines[line].substr(at, 6), nullptr, 16));
    };
    samples.push_back({half(i, 0), half(i + 1, 6), half(i + 1, 0)});
  }
  judge(fmt::format("user memory, I5049={}", period), samples, period, 20);
  const auto taken = static_cast<unsigned>(samples.size());
  b_.report.step(fmt::format("samples for the falls of SERVO, I5049={}", period),
                 taken * period <= passed + period && (taken + 1) * period >= passed,
                 fmt::format("{} samples, {} falls", taken, passed));
}

// The host follows the pointer at its own pace; what it takes is what was there when the pointer had passed.
void GatherBench::ring(unsigned period) {
  begin(3, period, std::to_string(kItems));
  b_.report.equal("size in the RAM", int{ram_.read(DPRAM_GATHER_SIZE)}, int{kItems});
  b_.expect("GATHER", "");
  std::vector<Sample> samples;
  unsigned place = 0;
  while (samples.size() < kTaken) {
    b_.bus.wait(pick(1'000'000));  // 8.5 ms at most: 19 samples
    const unsigned pointer = ram_.read(DPRAM_GATHER_POINTER);
    if (pointer >= kItems || pointer % 3 != 0) {
      b_.report.fail("pointer", std::to_string(pointer));
      break;
    }
    for (; place != pointer; place = (place + 3) % kItems)
      samples.push_back({item(place), item(place + 1) & 0xFFFFFF, item(place + 2) & 0xFFFFFF});
  }
  b_.expect("ENDGATHER", "");
  judge(fmt::format("round and round in the RAM, I5049={}", period), samples, period, kTaken);
}

void GatherBench::ends() {
  begin(2, 1, "10");
  b_.expect("GATHER", "");
  b_.bus.wait(10 * kMillisecond);
  b_.report.equal("pointer at the end", int{ram_.read(DPRAM_GATHER_POINTER)}, 12);  // four samples of three
  b_.expect("GATHER", "ERR003");
  b_.expect("DEFINE GATHER GATHER", "");
  b_.bus.wait(10 * kMillisecond);
  b_.report.equal("and from the beginning again", int{ram_.read(DPRAM_GATHER_POINTER)}, 12);
  b_.expect("DELETE GATHER", "");
}

void GatherBench::run() {
  b_.expect("M3->D:$20 I8=0 I5=2", "");
  b_.expect("OPEN PLC 0 CLEAR", "");
  b_.expect("P1=P1+1 M3=P1*16777217", "");
  b_.expect("CLOSE I5=3 ENABLE PLC 0", "");
  memory(1);
  memory(2 + pick(2));
  ring(1);
  ring(2 + pick(3));
  ends();
}

}  // namespace

Bench gather_bench() {
  return {"gather",
          "gathering into user memory and the dual-ported RAM: rate, order, halves, ends",
          {"the bench is told that I5049 is one higher than it is", "user memory, I5049=1",
           "servo interrupts since the last: 1, expected 2"},
          [](BenchContext& b) { GatherBench(b).run(); },
          kASlotOf16Bits};
}

}  // namespace brick
