#include "testbench/unit/component/bus_traffic.h"

#include <brick/board.h>

#include <deque>
#include <functional>
#include <map>

#include "systemc/cpu/port_a_master.h"
#include "systemc/host/isa_master.h"

namespace brick::component {
namespace {

constexpr std::uint32_t word_y(std::uint32_t a) { return 8 * a; }
constexpr std::uint32_t word_x(std::uint32_t a) { return 8 * a + 4; }
constexpr std::uint32_t kDpram = 0x60000, kServoIc0 = 0x78000, kLatches = 0x70010, kHostPort = 0xFFFFC2;
constexpr std::uint32_t kClockControl = word_x(0x78004), kDrivesClocks = 0x3008D2;
constexpr std::uint32_t kBcr = 0xFFFFFB, kPctl = 0xFFFFFD;
constexpr std::uint32_t kIo = 0x210, kPic = 0x218, kWindow = 0xD0000, kNobody = 0x300, kNoMemory = 0x80000;

constexpr unsigned kCells = 3;  // words of the RAM at which both meet

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }

 private:
  std::mt19937 engine_;
};

BusAccess port_a_access(Random& random) {
  BusAccess a;
  a.idle = random.below(8) == 0 ? 0 : random.below(1'000'000);
  a.write = random.below(2) == 0;
  a.value = random.word();
  switch (random.below(12)) {
    case 0:
      a.address = word_x(kServoIc0 + random.below(32));
      if (a.address == kClockControl) a.value = kDrivesClocks;  // they go on, and after a reset again
      break;
    case 1:
    case 2:
      a.address = word_x(kHostPort + random.below(6));
      break;
    case 3:
      a.address = word_x(kLatches + random.below(3));
      a.write = true;
      break;
    case 4:
      a.address = word_x(kBcr);
      break;
    case 5:
      a.address = word_x(kPctl);
      a.value = 3 + random.below(13);
      break;
    case 6:
      a.address = word_y(0x10000);  // no device
      break;
    default:
      a.address = 8 * kDpram + 4 * random.below(kCells);
  }
  return a;
}

BusAccess isa_access(Random& random) {
  BusAccess a;
  a.idle = random.below(8) == 0 ? 0 : random.below(400'000);
  a.write = random.below(2) == 0;
  a.value = random.word();
  a.length = 1;
  switch (random.below(12)) {
    case 0:
      a.socket = BusAccess::kIo;
      a.address = kIo + random.below(8);
      a.length = 1 + random.below(2);
      break;
    case 1:
    case 2:
      a.socket = BusAccess::kIo;
      a.address = kPic + random.below(4);
      break;
    case 3:
      a.socket = random.below(2) == 0 ? BusAccess::kIo : BusAccess::kMemory;
      a.address = a.socket == BusAccess::kIo ? kNobody : kNoMemory;
      a.length = 2;
      break;
    default:
      a.socket = BusAccess::kMemory;
      a.address = kWindow + random.below(2 * kCells);
      a.length = 1 + random.below(4);
      a.enables = random.below(3) == 0 ? random.below(16) : 0xF;
  }
  return a;
}

}  // namespace

BusTraffic bus_traffic(unsigned seed, Tick ticks) {
  Random port_a(seed), isa(seed + 1), pins(seed + 2);
  BusTraffic traffic;
  traffic.end = edge_time(ticks);
  traffic.port_a.push_back({20'000'000, BusAccess::kPortA, true, kClockControl, 4, kDrivesClocks, 0xF});
  traffic.isa.push_back({0, BusAccess::kIo, true, kPic + 2, 1, 0xFF, 0xF});  // all lines on
  Picoseconds at = 0;
  for (auto [list, random, make] :
       {std::tuple(&traffic.port_a, &port_a, &port_a_access), std::tuple(&traffic.isa, &isa, &isa_access)})
    for (Picoseconds time = 0; time < traffic.end; time += 500'000) list->push_back(make(*random));
  std::map<std::string, bool> levels{{"mi1", false}, {"mi2", false}, {"axexp0", false}, {"axexp1", false}};
  for (at = 1'000'000; at < traffic.end; at += 1 + pins.below(20'000'000)) {
    auto pin = levels.begin();
    std::advance(pin, pins.below(static_cast<std::uint32_t>(levels.size())));
    traffic.pins.push_back({at, pin->first, pin->second = !pin->second});
    if (pins.below(200) != 0) continue;
    traffic.pins.push_back({at += 1000, "rst_n", 0});  // in the middle of whatever is under way
    traffic.pins.push_back({at += 1'000'000, "rst_n", 1});
  }
  return traffic;
}

namespace {

Picoseconds instant(TimeFs time) { return static_cast<Picoseconds>(time / 1000) + 1; }

// One bus: its program, and where it stands in it.
struct Program {
  explicit Program(const std::vector<BusAccess>& list) : next(list.begin()), end(list.end()) {
    if (next != end) at = next->idle;
  }
  void over(Picoseconds time, std::uint32_t value, std::vector<Answer>& answers) {
    answers.emplace_back(time, value);
    busy = false;
    at = ++next == end ? ~Picoseconds{0} : time + next->idle;
  }
  std::vector<BusAccess>::const_iterator next, end;
  Picoseconds at = ~Picoseconds{0};  // of the next access
  bool busy = false;
};

class Bench {
 public:
  Bench(brick::Board& board, std::uint32_t fitted, const BusTraffic& traffic, BusFault fault)
      : board_(board), traffic_(traffic), fault_(fault), port_a_(traffic.port_a), isa_(traffic.isa) {
    for (const PinInfo& info : Board::pin_table(fitted))
      if (info.direction == PinDirection::kOut && info.word < kBoardOutputWords) outputs_.push_back(info);
    board_.on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      master_.board_changed(t, after);
      for (const PinInfo& info : outputs_) {
        const std::uint32_t mask = pin_mask(info.width), old = before.w[info.word] >> info.lsb & mask;
        const std::uint32_t level = after.w[info.word] >> info.lsb & mask;
        if (old != level) seen_.changes.emplace_back(edge_time(t), info.name, level);
      }
    };
    pins_.fitted = fitted;
    pins_.rst_n = true;
    master_.reset(0, 0, pins_);
    board_.set_inputs(pins_);
  }

  BusSeen run() {
    auto pin = traffic_.pins.begin();
    for (Tick t = 1; edge_time(t) < traffic_.end; ++t) {
      step();
      for (;;) {  // what comes before edge t, in the order of time; pins first
        const Picoseconds pin_at = pin == traffic_.pins.end() ? ~Picoseconds{0} : pin->time;
        const Picoseconds port_a_at = port_a_.busy ? ~Picoseconds{0} : port_a_.at;
        const Picoseconds isa_at = isa_.busy ? ~Picoseconds{0} : isa_.at;
        const Picoseconds first = std::min({pin_at, port_a_at, isa_at});
        if (first >= edge_time(t)) break;
        if (first == pin_at)
          set(*pin++);
        else if (first == port_a_at)
          begin_port_a();
        else
          begin_isa();
        step();
      }
      board_.run_until(t);
    }
    return std::move(seen_);
  }

 private:
  Tick now() const { return board_.now(); }
  void count(const BusAccess& a) { ++(a.write ? seen_.writes : seen_.reads); }

  void set(const PinChange& change) {
    if (change.pin == "rst_n") {
      const bool broken = master_.running();
      pins_.rst_n = change.value != 0;
      master_.reset(now(), 0, pins_);
      if (broken) port_a_.over(change.time, kNotMade, seen_.port_a);
    } else {
      const std::map<std::string, bool ConnectorPins::*> fields{{"mi1", &ConnectorPins::mi1},
                                                                {"mi2", &ConnectorPins::mi2},
                                                                {"axexp0", &ConnectorPins::axexp0},
                                                                {"axexp1", &ConnectorPins::axexp1}};
      pins_.*fields.at(change.pin) = change.value != 0;
    }
    board_.set_inputs(pins_);
  }

  void begin_port_a() {
    const BusAccess& a = *port_a_.next;
    const std::uint32_t word = a.address / 8;
    if (word == 0x10000) return port_a_.over(port_a_.at, kNotMapped, seen_.port_a);
    if (!pins_.rst_n) return port_a_.over(port_a_.at, kNotMade, seen_.port_a);
    count(a);
    std::int64_t cycle = std::max(master_.free_at(), master_.clock().first_cycle(std::max<Tick>(0, now() - 3)));
    const auto possible = [&] {
      const TimeFs time = master_.clock().time(cycle);
      return instant(time) > port_a_.at && fs_to_tick(time) > now();
    };
    while (!possible()) ++cycle;
    port_a_.busy = true;
    if (fault_ == BusFault::kLateAddress && seen_.port_a.size() >= 1000) {
      ++cycle;
      fault_ = BusFault::kNone;
    }
    master_.begin({word, a.address % 8 == 4, a.write, a.value, cycle, 0});
  }

  void begin_isa() {
    const BusAccess& a = *isa_.next;
    count(a);
    isa_.busy = true;
    isa_value_ = a.value;
    const unsigned bytes = a.length;
    for (unsigned i = 0; i < bytes;) {
      const std::uint32_t address = a.address + i;
      const auto on = [&a](unsigned k) { return (a.enables >> k & 1) != 0; };
      const bool two = a.socket == BusAccess::kMemory && address % 2 == 0 && i + 1 < bytes;
      if (on(i) || (two && on(i + 1))) cycles_.push_back({i, two && on(i + 1), on(i), false});
      i += two ? 2 : 1;
    }
    next_cycle(isa_.at);
  }

  struct Part {
    unsigned byte;   // first of the access
    bool upper, on;  // the second byte too; the first one at all
    bool narrow;
  };
  void next_cycle(Picoseconds asked) {
    const BusAccess& a = *isa_.next;
    if (cycles_.empty()) return isa_.over(asked, a.write ? a.value : isa_value_, seen_.isa);
    const Part part = cycles_.front();
    TimeFs start = std::max<TimeFs>(isa_free_, tick_to_fs(now())) / isa::kBclk * isa::kBclk;
    while (instant(start) <= asked || start < isa_free_ || fs_to_tick(start) <= now()) start += isa::kBclk;
    const bool memory = a.socket == BusAccess::kMemory;
    const std::uint32_t address = a.address + part.byte;
    const unsigned first = memory && !part.narrow ? address % 2 : 0;  // lane of the first byte
    const auto byte = [&](unsigned k) { return static_cast<unsigned>(a.value >> 8 * (part.byte + k) & 0xFF); };
    unsigned data = 0xFFFF;
    if (a.write && part.on) data ^= (byte(0) ^ 0xFF) << 8 * first;
    if (a.write && part.upper) data ^= (byte(1) ^ 0xFF) << 8;
    const IsaCommand command = memory    ? a.write ? IsaCommand::kMemoryWrite : IsaCommand::kMemoryRead
                               : a.write ? IsaCommand::kIoWrite
                                         : IsaCommand::kIoRead;
    const bool sbhe = memory && !part.narrow && (part.upper || first == 1);
    bus_.begin({command, address + (part.on ? 0 : 1), static_cast<std::uint16_t>(data), sbhe}, start, isa::kTypical,
               16);
  }

  void end_isa() {
    const BusAccess& a = *isa_.next;
    const Part part = cycles_.front();
    cycles_.pop_front();
    isa_free_ = bus_.free_at();
    if (a.socket == BusAccess::kMemory && !part.narrow && bus_.result().narrow) {  // byte by byte
      if (part.upper) cycles_.push_front({part.byte + 1, false, true, true});
      if (part.on) cycles_.push_front({part.byte, false, true, true});
    } else if (!a.write) {
      const bool wide = a.socket == BusAccess::kMemory && !part.narrow;
      const unsigned first = wide ? (a.address + part.byte) % 2 : 0;
      const auto take = [&](unsigned k, unsigned lane) {
        isa_value_ &= ~(0xFFu << 8 * (part.byte + k));
        isa_value_ |= (bus_.result().data >> 8 * lane & 0xFFu) << 8 * (part.byte + k);
      };
      if (part.on) take(0, first);
      if (part.upper) take(1, 1);
    }
    next_cycle(instant(bus_.end()));
  }

  // Whatever the masters do where the board stands.
  void step() {
    while (master_.running() && master_.stands_at() == now()) {
      master_.step(pins_, board_.outputs());
      board_.set_port_a(pins_);
      if (master_.strobe_moved()) master_.board_follows(board_.port_a_at_once());
    }
    if (master_.done()) {
      const PortACycle& c = master_.answer();
      const bool on_bus = c.address != kBcr && c.address != kPctl;
      const TimeFs end = on_bus ? c.end : master_.clock().time(master_.done_at());
      master_.take_answer();
      const BusAccess& a = *port_a_.next;
      port_a_.over(instant(end), a.write ? a.value : c.data, seen_.port_a);
    }
    while (bus_.running()) {
      if (bus_.drives()) {
        // Of some accesses: two of three ticks lie before the same edge of clk_ref as the next one.
        const bool late = fault_ == BusFault::kLateStrobe && seen_.isa.size() / 50 == 20;
        if (fs_to_tick(bus_.time()) - (late ? 0 : 1) > now()) return;
        bus_.drive(pins_);
        board_.set_inputs(pins_);
        bus_.driven();
      } else {
        if (now() < bus_.tick() && !bus_.stands(board_.outputs())) return;
        bus_.look(now(), board_.outputs());
        if (!bus_.running()) end_isa();
      }
    }
  }

  brick::Board& board_;
  const BusTraffic& traffic_;
  BusFault fault_;
  Program port_a_, isa_;
  std::vector<PinInfo> outputs_;
  BoardInputs pins_;
  PortAMaster master_;
  IsaMaster bus_;
  std::deque<Part> cycles_;
  std::uint32_t isa_value_ = 0;
  TimeFs isa_free_ = 0;
  BusSeen seen_;
};

}  // namespace

BusSeen run(brick::Board& board, std::uint32_t fitted, const BusTraffic& traffic, BusFault fault) {
  return Bench(board, fitted, traffic, fault).run();
}

}  // namespace brick::component
