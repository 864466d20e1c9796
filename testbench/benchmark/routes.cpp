#include "testbench/benchmark/routes.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"
#include "systemc/cpu/port_a_master.h"
#include "testbench/host/binary_rotary.h"
#include "testbench/host/dpram_port.h"
#include "testbench/host/host_link.h"

namespace brick {

namespace {

constexpr std::uint32_t kItems = 8192;  // of the buffer in the RAM
constexpr Tick kPatience = ns_to_ticks(2'000'000'000);

bool is_binary(Route route) { return route == Route::kBinary0 || route == Route::kBinary1; }

void need(bool met, const std::string& what) {
  if (!met) throw std::runtime_error(what);
}

void accepted(const Reply& reply, const std::string& line) {
  need(reply.complete, "no answer to " + line);
  need(!reply.error, line + " is refused: " + (reply.lines.empty() ? "?" : reply.lines.back()));
}

// A controller and a host that has opened its ring by one of the routes.
class Bench {
 public:
  Bench(Route route, unsigned words, Engine engine, const std::string& firmware) : route_(route) {
    MachineConfig config;
    config.engine = engine;
    config.firmware = firmware;
    machine_ = std::make_unique<Machine>(sc_core::sc_gen_unique_name("machine"), config);
    bus_ = std::make_unique<HostBus>(*machine_);
    link_ = std::make_unique<HostLink>(*bus_);
    need(link_->connect(ns_to_ticks(200'000'000)), "the firmware is silent");
    rotary_ = std::make_unique<BinaryRotary>(*bus_, 1);
    ram_ = std::make_unique<BusDpram>(*bus_);
    port_ = std::make_unique<DpramPort>(*ram_);
    command(fmt::format("I17=8388607 DELETE GATHER DEFINE ROT {}", words));
    if (route == Route::kRamAscii) {
      command("I58=1");
      bus_->wait(ns_to_ticks(5'000'000));  // the port is ready
    }
    if (route == Route::kBinary1) command("I45=1");
    machine_->on_host_bus = [this](TimeFs time, const BoardInputs& in, const BoardOutputs&) { strobes(time, in); };
    machine_->on_bus_cycle = [this](const PortACycle& c) { index_write(c); };
    bus_->watch(select_pins(pin::kBreq), [this](Tick now, const BoardOutputs&, const BoardOutputs& after) {
      if (after.get(pin::kBreq) != 0 || fell_at_) return;
      fell_at_ = now;
      written_ = last_write_;
    });
  }
  ~Bench() {
    bus_->watch({}, nullptr);
    machine_->on_host_bus = nullptr;
    machine_->on_bus_cycle = nullptr;
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  void command(const std::string& text) { accepted(link_->command(text), text); }

  void open() {
    if (route_ == Route::kRamAscii) {
      accepted(port_->command("OPEN ROT"), "OPEN ROT");
    } else {
      command(is_binary(route_) ? "OPEN BIN ROT" : "OPEN ROT");
    }
    if (!is_binary(route_)) return;
    need(rotary_->define(0, kItems) == BinaryResult::kOk, "no place for the buffer");
    rotary_->enable();
  }

  // Returns when the host has given it.
  void put(const std::string& line) {
    switch (route_) {
      case Route::kHostPort:
        command(line);
        break;
      case Route::kRamAscii:
        accepted(port_->command(line), line);
        break;
      default:
        for (const Tick begin = now(); rotary_->put(line) == BinaryResult::kBusy;)
          bus_->pause_polling(begin, begin + kPatience);
        break;
    }
    ++given_;
  }

  // Until the ring has all: the acknowledge has said so, or PMAC's index, at which the host looks.
  void finish() {
    const Tick limit = bus_->now() + kPatience;
    while (is_binary(route_) && copied_ < given_) {
      need(bus_->now() < limit, fmt::format("{} of {} lines were copied", copied_, given_));
      bus_->wait(ns_to_ticks(500));
    }
  }

  void settle(Tick ticks) { bus_->wait(ticks); }
  Tick now() const { return bus_->now(); }
  Tick finished_at() const { return is_binary(route_) ? copied_at_ : bus_->now(); }
  TimeFs written() const { return written_; }  // the last write before it
  std::optional<Tick> fell_at() const { return fell_at_; }
  void forget_fall() { fell_at_.reset(); }
  unsigned io = 0, memory = 0;
  double work() { return static_cast<double>(machine_->cpu().cycle() - machine_->cpu().slept()); }
  BinaryRotary& rotary() { return *rotary_; }
  void given(unsigned lines) { given_ += lines; }

 private:
  void strobes(TimeFs time, const BoardInputs& in) {
    const bool io_low = !in.isa_ior_n || !in.isa_iow_n, memory_low = !in.isa_memr_n || !in.isa_memw_n;
    const bool write_low = !in.isa_iow_n || !in.isa_memw_n;
    io += io_low && !io_low_ ? 1 : 0;
    memory += memory_low && !memory_low_ ? 1 : 0;
    if (write_low_ && !write_low) last_write_ = time;
    io_low_ = io_low;
    memory_low_ = memory_low;
    write_low_ = write_low;
  }

  void index_write(const PortACycle& c) {
    constexpr std::uint32_t kIndex = DPRAM_ROTARY_HEADERS + DPRAM_ROTARY_PMAC_INDEX;
    if (!c.write || !c.x || c.address != regs::kDpramBase + kIndex / DPRAM_ITEM_BYTES) return;
    ++copied_;
    copied_at_ = fs_to_tick(c.strobe_high);
  }

  Route route_;
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<HostBus> bus_;
  std::unique_ptr<HostLink> link_;
  std::unique_ptr<BinaryRotary> rotary_;
  std::unique_ptr<BusDpram> ram_;
  std::unique_ptr<DpramPort> port_;
  bool io_low_ = false, memory_low_ = false, write_low_ = false;
  unsigned given_ = 0, copied_ = 0;
  Tick copied_at_ = 0;
  TimeFs last_write_ = 0, written_ = 0;
  std::optional<Tick> fell_at_;
};

double seconds_of(Tick ticks) { return static_cast<double>(tick_to_fs(ticks)) * 1e-15; }

double lines_per_second(Bench& bench, unsigned axes, unsigned lines, bool one_by_one) {
  const Tick begin = bench.now();
  for (unsigned i = 0; i < lines; ++i) {
    bench.put(route_line(axes, i));
    if (one_by_one) bench.finish();
  }
  bench.finish();
  return lines / seconds_of(bench.finished_at() - begin);
}

// What the CPU does while nothing comes, in cycles a tick.
double idle_work(Bench& bench) {
  constexpr Tick kTime = ns_to_ticks(40'000'000);
  const double before = bench.work();
  bench.settle(kTime);
  return (bench.work() - before) / static_cast<double>(kTime);
}

// Binary lines stand in the RAM before the header is enabled: a background that looks again and again would count.
double binary_cycles(Route route, unsigned axes, unsigned lines, Engine engine, const std::string& firmware) {
  Bench bench(route, lines * axes + 10, engine, firmware);
  const double idle = idle_work(bench);
  bench.open();
  bench.rotary().disable();
  for (unsigned i = 0; i < lines; ++i)
    need(bench.rotary().put(route_line(axes, i)) == BinaryResult::kOk, "no room for the lines");
  bench.given(lines);
  const Tick begin = bench.now();
  const double before = bench.work();
  bench.rotary().enable();
  bench.finish();
  return (bench.work() - before - idle * static_cast<double>(bench.now() - begin)) / lines;
}

double ascii_cycles(Route route, unsigned axes, unsigned lines, Engine engine, const std::string& firmware) {
  Bench bench(route, lines * axes + 10, engine, firmware);
  const double idle = idle_work(bench);
  bench.open();
  const Tick begin = bench.now();
  const double before = bench.work();
  lines_per_second(bench, axes, lines, false);
  return (bench.work() - before - idle * static_cast<double>(bench.now() - begin)) / lines;
}

// PLCs whose scan takes some milliseconds, without a loop.
void enter_plcs(Bench& bench) {
  for (unsigned plc = 1; plc <= 4; ++plc) {
    bench.command(fmt::format("OPEN PLC {} CLEAR", plc));
    for (unsigned i = 0; i < 40; ++i) bench.command("P100=SIN(P101*2.5)+SQRT(P102*P102+7)*COS(P103)");
    bench.command("CLOSE");
  }
  bench.command("I5=2");
  bench.command("ENABLE PLC 1..4");
}

}  // namespace

const char* route_name(Route route) {
  static const char* const names[] = {"ASCII, host port", "ASCII, dual-ported RAM", "binary, I45=0", "binary, I45=1"};
  return names[static_cast<int>(route)];
}

std::string route_line(unsigned axes, unsigned number) {
  std::string line;
  for (unsigned axis = 0; axis < axes; ++axis)
    line += fmt::format("{}{}.{}", "XYZABCUVW"[axis], 1000 + (number + 37 * axis) % 9000, number % 2 == 0 ? 5 : 25);
  return line;
}

double measure_lines_per_second(Route route, unsigned axes, unsigned lines, Engine engine,
                                const std::string& firmware) {
  Bench bench(route, lines * axes + 10, engine, firmware);
  bench.open();
  return lines_per_second(bench, axes, lines, false);
}

RouteSpeed measure_route(Route route, unsigned axes, unsigned lines, Engine engine, const std::string& firmware) {
  RouteSpeed speed{};
  {
    Bench bench(route, lines * axes + 10, engine, firmware);
    bench.open();
    bench.io = bench.memory = 0;
    speed.lines_per_second = lines_per_second(bench, axes, lines, false);
    speed.io_cycles = static_cast<double>(bench.io) / lines;
    speed.memory_cycles = static_cast<double>(bench.memory) / lines;
    constexpr double kIoUs = 0.84, kMemoryUs = 0.48;  // 7 and 4 BCLK of 120 ns (docs/benches.md)
    speed.bus_us = kIoUs * speed.io_cycles + kMemoryUs * speed.memory_cycles;
  }
  {
    const unsigned few = std::max(1u, lines / 8);
    Bench bench(route, few * axes + 10, engine, firmware);
    bench.open();
    speed.lines_one_by_one = lines_per_second(bench, axes, few, true);
  }
  speed.cpu_cycles = is_binary(route) ? binary_cycles(route, axes, lines, engine, firmware)
                                      : ascii_cycles(route, axes, lines, engine, firmware);
  return speed;
}

std::vector<double> measure_breq_us(Route route, unsigned lines, bool plcs, const std::string& firmware) {
  Bench bench(route, 2 * lines + 10, Engine::kSystemC, firmware);
  if (plcs) enter_plcs(bench);
  bench.open();
  std::mt19937 random(11);
  std::vector<double> found;
  for (unsigned i = 0; i < lines; ++i) {
    bench.settle(static_cast<Tick>(random() % ns_to_ticks(20'000'000)));
    bench.forget_fall();
    bench.put(route_line(2, i));
    for (unsigned tries = 0; !bench.fell_at() && tries < 100'000; ++tries) bench.settle(ns_to_ticks(1'000));
    need(bench.fell_at().has_value(), "BREQ does not fall");
    found.push_back(static_cast<double>(tick_to_fs(*bench.fell_at()) - bench.written()) * 1e-9);
    bench.finish();
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace brick
