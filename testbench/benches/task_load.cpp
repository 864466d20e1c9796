// task-load: what the controller's tasks may cost with eight motors that it commutates, all moving, and a host that
// never pauses (motion:1.6), in moves and in segments looked ahead. Own times of each run of a task, which are its
// length less what interrupted it; interrupts taken against the falls of PHASE and SERVO; characters of the host port
// in each phase period. At the factory clocks and at a Brick's, with I52 = 24. Programs do not end; each stage proves
// by its own samples that all eight motors move.
#include <algorithm>
#include <random>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cpu/port_a.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/fall_limits.h"
#include "testbench/checkers/task_times.h"

namespace brick {
namespace {

constexpr unsigned kPace = 8;                  // characters in a phase period while a motor is enabled
constexpr unsigned kRareRealTime = 4;          // I8: the servo task looks at motors in turn
constexpr unsigned kSegment = 5, kAhead = 20;  // ms; Isx20
constexpr double kContinuous = 10'000;         // Ixx57
constexpr double kAbort = 2;                   // Ixx15, counts/ms^2: no program slows down so fast and so evenly
constexpr std::uint64_t kGatheringServo = 10'000, kBrickPhase = 6'000, kBrickServo = 10'000;

// What the CPU does from now on, until it goes.
class Watch {
 public:
  explicit Watch(BenchContext& b) : b_(b), task_(b.machine.on_task), cycle_(b.machine.on_bus_cycle) {
    b_.machine.on_task = [this](TimeFs time) {
      if (task_) task_(time);
      const unsigned task = b_.machine.task(), before = std::exchange(last_, task);
      tasks.changed(time, task);
      if (task == TaskTimes::kPhase && before != task) phase_began();
      if (task == TaskTimes::kServo && before < task) ++servo;
    };
    b_.machine.on_bus_cycle = [this](const PortACycle& c) {
      if (cycle_) cycle_(c);
      const bool port = c.on_chip && c.x && (c.address == (c.write ? regs::hi08::kHotx : regs::hi08::kHorx).address);
      if (port) ++characters_, ++all_characters;
    };
    b_.bus.watch(select_pins(pin::kPhase, pin::kServo), [this](Tick, const BoardOutputs& was, const BoardOutputs& is) {
      phase_falls += was.get(pin::kPhase) != 0 && is.get(pin::kPhase) == 0 ? 1 : 0;
      servo_falls += was.get(pin::kServo) != 0 && is.get(pin::kServo) == 0 ? 1 : 0;
    });
  }
  ~Watch() {
    b_.bus.watch({}, nullptr);
    b_.machine.on_task = task_;
    b_.machine.on_bus_cycle = cycle_;
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  TaskTimes tasks;
  unsigned phase = 0, servo = 0, phase_falls = 0, servo_falls = 0, most_characters = 0, all_characters = 0;

 private:
  void phase_began() {
    ++phase;
    most_characters = std::max(most_characters, std::exchange(characters_, 0));
  }

  BenchContext& b_;
  std::function<void(TimeFs)> task_;
  std::function<void(const PortACycle&)> cycle_;
  unsigned last_ = 0, characters_ = 0;
};

class TaskLoad {
 public:
  explicit TaskLoad(BenchContext& b) : b_(b), host_(b) {}
  void run();

 private:
  void set_up();
  void start();
  void own_times(const std::string& name, double ms, std::uint64_t phase, std::uint64_t servo);
  void judge(const std::string& name, const TaskTimes& tasks, std::uint64_t phase, std::uint64_t servo);
  using Step = std::function<bool(const MotorHost::Sample* three)>;
  unsigned steps_of_all(const Step& is);
  void run_program(unsigned number);
  double any(double most) { return std::uniform_real_distribution<>(0, most)(random_); }
  void moves(const std::string& name);
  void begin_together(const std::string& name);
  void slow_down(const std::string& name);
  void never_pausing_host(const std::string& name, double ms);
  void abort(const std::string& name);
  void rapid();
  void segments();
  void brick_clocks();

  BenchContext& b_;
  MotorHost host_;
  std::mt19937 random_{static_cast<std::uint32_t>(b_.seed)};  // when programs begin and are aborted
};

bool is_moving(const MotorHost::Sample* s) {
  return s[2].enabled && s[2].commanded != s[1].commanded && s[2].output != s[1].output && s[2].turned != s[1].turned;
}

bool is_beginning(const MotorHost::Sample* s) {
  return s[0].commanded == s[1].commanded && s[1].commanded != s[2].commanded;
}

bool is_fast(const MotorHost::Sample* s) { return std::fabs(s[2].commanded - s[1].commanded) > 2 * kAbort; }

std::vector<plant::AxisParameters> axes() {
  plant::AxisParameters a;
  a.drive = plant::Drive::kThreePhase;
  a.motor.inertia = 1e-5;
  a.motor.viscous = 1e-4;
  a.motor.torque_constant = 0.1;
  a.amplifier.bus_volts = 48;
  a.amplifier.full_scale_amps = 10;
  a.amplifier.trip_amps = 15;
  a.encoder.wiring = plant::EncoderParameters::Wiring::kHalls;
  a.encoder.pole_pairs = a.motor.pole_pairs;
  a.encoder.hall_offset = -1000 * plant::kUnitsPerCount / 6;  // Ixx91 = $800000: state 011 is 0 to 60 degrees
  return std::vector<plant::AxisParameters>(8, a);
}

// As examples/setups/servo8.pmc, with gains that are low enough for both clocks and protection that nobody tests here.
void TaskLoad::set_up() {
  host_.set_up();
  std::vector<std::string> words;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const auto at = [&](unsigned k, const std::string& value) {
      words.push_back(fmt::format("I{}={}", 100 * motor + k, value));
    };
    words.push_back(fmt::format("I{}=0", host_.i_channel(motor - 1, 6)));
    at(0, "0");
    at(1, "1");
    at(24, "$C00400");
    at(82, fmt::format("${:X}", host_.address(motor - 1, word::kAdcB)));
    at(83, fmt::format("${:X}", host_.address(motor - 1, word::kPhasePosition)));
    at(81, fmt::format("${:X}", host_.address(motor - 1, word::kStatus)));
    at(91, "$800000");
    at(13, "1000000");
    at(14, "-1000000");
    at(84, "$FFFC00");
    for (const auto& [k, value] : {std::pair{70u, 4.0},
                                   {71u, 4000.0},
                                   {72u, 1365.0},
                                   {61u, 0.011},
                                   {62u, 0.2},
                                   {66u, 7180.0},
                                   {15u, kAbort},
                                   {30u, 20000.0},
                                   {31u, 1000.0},
                                   {69u, 8000.0},
                                   {57u, kContinuous},
                                   {58u, 20000.0},
                                   {11u, 0.0},
                                   {12u, 0.0}})
      at(k, fmt::format("{}", value));
    at(0, "1");
  }
  host_.say(words);
  // A limit that does not hold would be found: the loops of 24 motors more, killed as they are.
  if (b_.negative) host_.expect("I900,24,100=1", "");
  host_.expect("&1 #1->1000X #2->1000Y #3->1000Z #4->1000A #5->1000B #6->1000C #7->1000U #8->1000V", "");
  const auto program = [this](const std::string& mode, std::initializer_list<const char*> ways) {
    host_.expect(mode, "");
    host_.expect("WHILE(1=1)", "");
    for (const char* way : ways) host_.expect(fmt::format("X{0}Y{0}Z{0}A{0}B{0}C{0}U{0}V{0}", way), "");
    host_.expect("ENDWHILE CLOSE", "");
  };
  program("OPEN PROG 1 CLEAR LINEAR INC TA4 TS1 TM20", {"0.2", "0.13", "0.15", "0.22"});  // it never stands
  program("OPEN PROG 2 CLEAR RAPID INC", {"0.4", "-0.3"});
}

// All closed and moving, in a program that ends only with the bench.
void TaskLoad::start() {
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) host_.expect(fmt::format("#{}$", motor), "");
  host_.wait_ms(13);  // Ixx92
  run_program(1);
}

void TaskLoad::run_program(unsigned number) {
  host_.wait_ms(any(2));
  host_.record();
  host_.expect(fmt::format("&1B{}R", number), "");
  for (int waited = 0; waited < 200 && steps_of_all(is_moving) == 0; ++waited) host_.wait_ms(host_.period());
}

// Of three samples of each motor, one after the other: whether all eight do the same in one servo interrupt.
unsigned TaskLoad::steps_of_all(const Step& is) {
  unsigned steps = 0;
  for (std::size_t i = 2; i < host_.samples(host_.motors()).size(); ++i) {
    bool all = true;
    for (unsigned motor = 1; motor <= host_.motors(); ++motor) all &= is(&host_.samples(motor)[i - 2]);
    steps += all ? 1 : 0;
  }
  return steps;
}

void TaskLoad::moves(const std::string& name) {
  const auto all = static_cast<unsigned>(host_.samples(1).size()) - 2;
  const unsigned moving = steps_of_all(is_moving);
  b_.report.step("eight motors moving at once, " + name, moving >= 15 && 10 * moving >= 9 * all,
                 fmt::format("in {} of {} servo interrupts", moving, all));
}

void TaskLoad::begin_together(const std::string& name) {
  const unsigned times = steps_of_all(is_beginning);
  b_.report.step("eight motors begin in one servo interrupt, " + name, times >= 3, fmt::format("{} times", times));
}

// Each by Ixx15 from one interrupt to the next, which no motor does that stands at the abort.
void TaskLoad::slow_down(const std::string& name) {
  const double by = kAbort * host_.period() * host_.period();
  unsigned least = ~0u;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const auto& s = host_.samples(motor);
    unsigned slower = 0;
    for (std::size_t i = 2; i < s.size(); ++i) {
      const double step = s[i].commanded - s[i - 1].commanded, before = s[i - 1].commanded - s[i - 2].commanded;
      slower += step * before > 0 && std::fabs(std::fabs(before) - std::fabs(step) - by) < 0.01 ? 1 : 0;
    }
    least = std::min(least, slower);
  }
  b_.report.step("eight motors slow down by Ixx15, " + name, least >= 5,
                 fmt::format("in {} servo interrupts or more", least));
}

void TaskLoad::own_times(const std::string& name, double ms, std::uint64_t phase, std::uint64_t servo) {
  Watch watch(b_);
  host_.record();
  host_.wait_ms(ms);
  judge(name, watch.tasks, phase, servo);
}

void TaskLoad::judge(const std::string& name, const TaskTimes& tasks, std::uint64_t phase, std::uint64_t servo) {
  const double servo_ms = std::strtod(b_.ask("I10").c_str(), nullptr) / 8'388'608;
  const auto cycles = [this](TimeFs t) { return static_cast<std::uint64_t>(t / b_.machine.cpu_period()); };
  const double real_time = std::strtod(b_.ask("I8").c_str(), nullptr) + 1;
  const double slice = real_time * servo_ms * 1e12 / 2;  // fs: half of a real-time period
  const struct {
    const char* name;
    unsigned task;
    std::uint64_t most;
  } limits[] = {{"phase", TaskTimes::kPhase, phase},
                {"servo", TaskTimes::kServo, servo},
                {"real-time", TaskTimes::kRealTime, cycles(static_cast<TimeFs>(slice))}};
  for (const auto& l : limits) {
    const TaskTimes::Runs& runs = tasks.runs(l.task);
    b_.report.step(
        fmt::format("{} task, {}", l.name, name), FallLimits::keeps_cycles(runs.count, cycles(runs.longest), l.most),
        fmt::format("{} cycles of its own at most, of {}; {} times", cycles(runs.longest), l.most, runs.count));
  }
}

// It writes whenever there is room and reads whatever there is. Half of its lines are answered at length.
void TaskLoad::never_pausing_host(const std::string& name, double ms) {
  static const std::string lines = "#1?P#2?P#3?P\rP1=1 P2=2 P3=3 P4=4 P5=5\r??\r";
  Watch watch(b_);
  host_.record();
  const Tick end = b_.bus.now() + ns_to_ticks(static_cast<std::uint64_t>(ms * 1e6));
  for (std::size_t i = 0; b_.bus.now() < end;) {
    if (b_.bus.put_char(static_cast<std::uint8_t>(lines[i % lines.size()]), 0)) ++i;
    (void)b_.bus.get_char(0);
  }
  moves(name);
  const auto near = [](unsigned a, unsigned b) { return a + 1 >= b && a <= b + 1; };  // one is under way
  b_.report.step(name + ": phase interrupts", watch.phase > 50 && near(watch.phase, watch.phase_falls),
                 fmt::format("{} for {} falls of PHASE", watch.phase, watch.phase_falls));
  b_.report.step(name + ": servo interrupts", watch.servo > 10 && near(watch.servo, watch.servo_falls),
                 fmt::format("{} for {} falls of SERVO", watch.servo, watch.servo_falls));
  const unsigned busy = watch.all_characters / std::max(watch.phase, 1u);
  b_.report.step(name + ": characters in a phase period", watch.most_characters <= kPace && busy >= kPace / 2,
                 fmt::format("{} at most, {} on the whole in {}; expected {} at most", watch.most_characters,
                             watch.all_characters, watch.phase, kPace));
  b_.bus.put_char(0x18, ns_to_ticks(1'000'000));  // ^X: what it has not read
  while (b_.bus.get_char(ns_to_ticks(2'000'000))) {}
  b_.report.step("the controller answers", b_.link.connect(ns_to_ticks(50'000'000)), "I3=2 I6=1 I4=0");
  judge(name, watch.tasks, FallLimits::kPhaseCycles, FallLimits::kServoCycles);
}

// The motors leave the path and stop one after the other.
void TaskLoad::abort(const std::string& name) {
  Watch watch(b_);
  host_.wait_ms(any(2));
  host_.record();
  host_.expect("&1A", "");
  host_.wait_ms(20);
  judge("abort of " + name, watch.tasks, FallLimits::kPhaseCycles, FallLimits::kServoCycles);
  slow_down("abort of " + name);
}

// What costs the servo task most: each motor goes along a path of its own, and all begin, change their acceleration and
// stop in the same servo interrupts; the servo task looks for what is urgent about two motors, with their limits.
void TaskLoad::rapid() {
  host_.say({fmt::format("I8={}", kRareRealTime)});
  run_program(2);
  own_times("RAPID", 200, FallLimits::kPhaseCycles, FallLimits::kServoCycles);
  begin_together("RAPID");
  host_.expect("I8", std::to_string(kRareRealTime));
  host_.record();
  for (int waited = 0; waited < 200 && steps_of_all(is_fast) == 0; ++waited) host_.wait_ms(host_.period());
  abort("RAPID");
  host_.say({"I8=2"});
}

// The same program in segments that are looked ahead, from its start on: segments are made as fast as they can be until
// the buffer is full, and the motors are limited.
void TaskLoad::segments() {
  host_.expect("DELETE GATHER", "");
  host_.expect(fmt::format("&1DEFINE LOOKAHEAD {},10", 2 * kAhead), "");
  host_.say({fmt::format("I5113={} I5120={}", kSegment, kAhead)});
  host_.variables(17, 1);
  run_program(1);
  never_pausing_host("segments, a host that never pauses", 60);
  b_.report.equal("segments: run-time error", host_.ask("RY$2014"), std::string("0"));
  abort("segments");
  host_.say({"I5113=0 I5120=0"});
}

// servo-ic:11.2; I52 counts from the start on.
void TaskLoad::brick_clocks() {
  host_.expect("&1A", "");
  b_.link.control(0x0B);  // ^K; dividers first: 40 kHz would leave the CPU nothing
  for (const char* line :
       {"I7001=3 I7101=3 I7002=1 I7102=1 I7000=1473 I7100=1473", "I7003=1746 I7103=1746 I10=1677653", "I52=24", "SAVE"})
    b_.ask(line);
  b_.link.command("$$$");
  if (!b_.link.connect(HostLink::kBootTime)) b_.report.fail("controller answers", "nothing after $$$");
  host_.expect("I52", "24");
}

void TaskLoad::run() {
  if (host_.motors() < 8) return b_.report.fail("eight channels", std::to_string(host_.motors()));
  set_up();
  start();
  own_times("eight axes", 60, FallLimits::kPhaseCycles, FallLimits::kServoCycles);
  moves("eight axes");
  host_.expect("DELETE GATHER I5000=0 I5049=1 I5050=$FF", "");
  for (unsigned i = 0; i < 8; ++i) host_.expect(fmt::format("I{}=${:X}", 5001 + i, 0x800088 + 0x80 * i), "");
  host_.expect("DEFINE GATHER 4000", "");
  host_.expect("GATHER I48=1", "");
  own_times("eight gathered words and I48", 12, FallLimits::kPhaseCycles, kGatheringServo);
  moves("eight gathered words and I48");
  host_.expect("ENDGATHER I48=0", "");
  never_pausing_host("a host that never pauses", 10);
  host_.variables(57, -kContinuous);
  own_times("linear I2T", 30, FallLimits::kPhaseCycles, FallLimits::kServoCycles);
  moves("linear I2T");
  host_.variables(57, kContinuous);
  abort("a program");
  rapid();
  segments();
  brick_clocks();
  start();
  own_times("Brick clocks, I52=24", 10, kBrickPhase, kBrickServo);
  moves("Brick clocks");
}

}  // namespace

Bench task_load_bench() {
  return {"task-load",
          "eight commutated motors, gathering, a host that never pauses: own times of the tasks, no interrupt lost",
          {"24 motors more are activated", "servo task, eight axes", "cycles of its own at most, of 8000"},
          [](BenchContext& b) { TaskLoad(b).run(); },
          kServoIcs01,
          axes};
}

}  // namespace brick
