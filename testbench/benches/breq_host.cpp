#include "testbench/benches/breq_host.h"

#include <algorithm>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cpu/port_a.h"

namespace brick {

namespace {

constexpr std::uint8_t kBreqBit = 0x02;  // IR1

// &n?? answers three words of six digits; Rotary Buffer Full is bit 16 of the second (host-bus:5.4): the value-1 bit of
// the eighth character.
bool full_bit(const std::string& status) {
  const char c = status.at(7);
  return (c <= '9' ? c - '0' : c - 'A' + 10) & 1;
}

}  // namespace

BreqHost::BreqHost(BenchContext& context, Tick line_time)
    : context_(context), scoreboard_(line_time), random_(context.seed) {
  context_.bus.watch(select_pins(pin::kBreq), [this](Tick now, const BoardOutputs&, const BoardOutputs& after) {
    scoreboard_.edge(now, after.get(pin::kBreq) != 0);
  });
  if (context_.machine.outputs().get(pin::kBreq)) scoreboard_.edge(context_.bus.now(), true);
  judge_ = context_.machine.on_host_bus;
  context_.machine.on_host_bus = [this](TimeFs time, const BoardInputs& in, const BoardOutputs& out) {
    if (judge_) judge_(time, in, out);
    if (strobe_low_ && in.isa_iow_n) strobe_ = time;
    strobe_low_ = !in.isa_iow_n;
  };
  cycle_ = context_.machine.on_bus_cycle;
  context_.machine.on_bus_cycle = [this](const PortACycle& c) {
    if (cycle_) cycle_(c);
    if (c.on_chip && !c.write && c.x && c.address == regs::hi08::kHorx.address && (c.data & 0xFF) == '\r')
      taken_ = c.strobe_high;
  };
  profile_ = context_.machine.on_task;
  context_.machine.on_task = [this](TimeFs time) {
    if (profile_) profile_(time);
    tasks_.changed(time, context_.machine.task());
  };
}

BreqHost::~BreqHost() {
  context_.bus.watch({}, nullptr);
  context_.machine.on_host_bus = judge_;
  context_.machine.on_bus_cycle = cycle_;
  context_.machine.on_task = profile_;
}

Reply BreqHost::must(const std::string& command) {
  Reply reply = context_.link.command(command);
  if (!reply.complete) throw HostBusError("no reply to `" + command + "`; expected: acknowledge or error");
  if (reply.error)
    context_.report.fail(command, (reply.lines.empty() ? "error" : reply.lines.back()) + ", expected no error");
  return reply;
}

std::string BreqHost::ask(const std::string& command) {
  const Reply reply = must(command);
  return reply.lines.empty() ? "" : reply.lines.front();
}

void BreqHost::open() {
  scoreboard_.select(selected_, context_.bus.now());
  must("OPEN ROTARY");
  settle();
}

void BreqHost::set_limits(unsigned i16, unsigned i17) {
  scoreboard_.limits(i16, i17);
  selected_ = 0;
  scoreboard_.select(selected_, context_.bus.now());
  for (const char* command : {"&2CLEAR", "&1CLEAR", "CLOSE"})
    must(command);  // an assignment would be stored in an open buffer
  must(fmt::format("I16={} I17={}", i16, context_.negative ? i17 + 1 : i17));
  open();
}

void BreqHost::select(unsigned cs) {
  settle();
  scoreboard_.select(cs, context_.bus.now());
  must(fmt::format("&{}", cs + 1));
  selected_ = cs;
  settle();
}

void BreqHost::clear() {
  scoreboard_.empty(selected_);
  scoreboard_.select(selected_, context_.bus.now());
  must("CLEAR");
  settle();
}

void BreqHost::run() {
  scoreboard_.run(selected_, context_.bus.now());
  must("R");
}

void BreqHost::stop() {
  must("A");
  scoreboard_.halt(selected_, context_.bus.now());
}

bool BreqHost::line(const std::string& text) {
  HostLink& link = context_.link;
  tasks_.forget_changes();
  if (!link.send(text)) throw HostBusError("the host port takes no character of `" + text + "`; expected: TXDE");
  const TimeFs strobe = strobe_;
  scoreboard_.line_sent(context_.bus.now());
  const Reply reply = link.finish();
  const TimeFs sent = from_port_ ? std::max(strobe, taken_) : strobe;
  fall_time_.reset();
  if (const TimeFs fell = tick_to_fs(scoreboard_.fell_at()); fell > sent)
    fall_time_ = {fell - sent, fell - sent - tasks_.above_background(sent, fell)};
  if (!reply.complete) throw HostBusError("no reply to the line `" + text + "`; expected: acknowledge");
  if (reply.error) {
    context_.report.fail("line " + text, reply.lines.back() + ", expected: stored");
    return false;
  }
  scoreboard_.line_stored(context_.bus.now());
  return true;
}

void BreqHost::settle() {
  context_.bus.wait(BreqScoreboard::kSettled);
  scoreboard_.settled(context_.bus.now());
}

unsigned BreqHost::lines_ahead() {
  const Tick from = context_.bus.now();
  const std::string answer = ask("PR");
  const auto lines = static_cast<unsigned>(std::strtoul(answer.c_str(), nullptr, 10));
  scoreboard_.lines_ahead(from, context_.bus.now(), lines);
  return lines;
}

bool BreqHost::full() {
  const Tick from = context_.bus.now();
  const std::string answer = ask("??");
  if (answer.size() != 18) {
    context_.report.fail("??", "`" + answer + "`, expected 18 hex digits");
    return false;
  }
  scoreboard_.full_bit(from, context_.bus.now(), full_bit(answer));
  return full_bit(answer);
}

bool BreqHost::signal() {
  const Tick from = context_.bus.now();
  const bool high = context_.bus.read_pic_signals() & kBreqBit;
  scoreboard_.signal(from, context_.bus.now(), high, "SIG bit 1");
  return high;
}

void BreqHost::check() {
  lines_ahead();
  full();
  signal();
}

void BreqHost::enable_interrupt() {  // host-bus:4.4: edge mode, BREQ alone
  context_.bus.write_pic_edge_level(0x00);
  context_.bus.clear_pic();
  context_.bus.write_pic_mask(kBreqBit);
}

bool BreqHost::wait_interrupt(Tick timeout) {
  if (!context_.bus.wait_pin(pin::kIsaIrq, 1, timeout)) return false;
  const std::uint8_t status = context_.bus.read_pic_status();
  if (status != kBreqBit) context_.report.fail("interrupt status", fmt::format("IST={:02X}, expected 02", status));
  context_.bus.clear_pic();
  ++interrupts_;
  return true;
}

// Different lengths and forms; one short move or wait each, so that at most one line is taken in a real-time interrupt.
std::string BreqHost::motion_line() {
  switch (random(4)) {
    case 0:
      return "P1=P1+1 DWELL0";
    case 1:
      return fmt::format("P1=P1+1 X{}.{}", random(3), random(1000));
    case 2:
      return fmt::format("X{} Y{} P1=P1+1", random(2), random(2));
    default:
      return fmt::format("P1=P1+1 P2={}*(P1+{}) DELAY0.5", random(9), random(9));
  }
}

bool BreqHost::verdict(const std::string& step, const BreqScoreboard::Counts& least) {
  const auto& violations = scoreboard_.violations();
  const BreqScoreboard::Counts c = scoreboard_.counts() - counted_;
  counted_ = scoreboard_.counts();
  const auto text = [](const BreqScoreboard::Counts& n) {
    return fmt::format("{} lines, BREQ pulsed {} times, stayed low {} times, raised by execution {} times, {} queries",
                       n.lines, n.pulses, n.stays_low, n.raised_by_execution, n.queries);
  };
  const auto cover = [&](const char* what, unsigned count, unsigned needed) {
    if (needed > 0) context_.report.cover(fmt::format("{}, {}", step, what), count, needed);
  };
  std::string detail = text(c);
  cover("lines", c.lines, least.lines);
  cover("pulses of BREQ", c.pulses, least.pulses);
  cover("BREQ stays low", c.stays_low, least.stays_low);
  cover("BREQ raised by execution", c.raised_by_execution, least.raised_by_execution);
  cover("queries", c.queries, least.queries);
  if (!c.reaches(least)) detail += "; expected at least " + text(least);
  const bool good = violations.size() == reported_;
  if (!good) {
    detail += fmt::format("; {} violations, the first: {}", violations.size() - reported_, violations[reported_]);
    reported_ = violations.size();
  }
  return context_.report.step(step, good && c.reaches(least), detail);
}

}  // namespace brick
