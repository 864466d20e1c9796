// Who may run ahead of whom (docs/architecture.md): the CPU runs to where the board's pins are known plus the interrupt
// latency, the board to where the CPU stands or to the next edge of a bus cycle, until the board has come to the limit.
// Results do not depend on how far each step goes, only speed does.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "systemc/machine/machine_impl.h"

namespace brick {

namespace {
constexpr BoardOutputs kWakesCpu = select_pins(pin::kPhase, pin::kServo, pin::kIrqHost, pin::kWdTripped);

constexpr BoardOutputs kSsiClocks = select_pins(pin::kSsiClk);
constexpr Tick kDebuggerLatency = 20'000;  // no advance is longer when a debugger may want to break in

BoardOutputs both(BoardOutputs a, const BoardOutputs& b) {
  for (unsigned i = 0; i < kBoardOutputWords; ++i) a.w[i] |= b.w[i];
  return a;
}
}  // namespace

Tick Machine::Impl::run_until(Tick limit, const BoardOutputs& stop) {
  if (tracing_cpu != named.traces_pc()) trace_cpu(named.traces_pc());
  motors.begin_run();
  stop_on = stop;
  stopped = false;
  // At a clock of an absolute encoder the board stops, the run does not.
  const BoardOutputs stops = motors.has_ssi() ? both(stop_on, kSsiClocks) : stop_on;
  const BoardOutputs watched = both(kWakesCpu, stops);
  const Tick begin = board->now();
  Tick now = begin;
  run_cpu(now);
  while (now < limit && !stopped) {
    motors.step();
    if (host_inputs.ssi_data != motors.ssi_data() && motors.has_ssi()) drive_ssi();
    Tick target = std::min(std::min(limit, motors.next_event()), std::min(reset_until, init_at));
    if (config.batch > 0) target = std::min(target, now + config.batch);
    if (debugger != nullptr) {  // it must be heard while the CPU sleeps, too
      debugger->poll(!cpu_runs || (cpu.asleep() && !port_a.running()));
      target = std::min(target, now + kDebuggerLatency);
    }
    if (cpu_runs && !port_a.running() && !cpu.asleep())
      run_cpu(std::max(now, std::min(target, board->quiet_until(watched))));
    target = board_limit(target, now);
    if (target > now) now = board->run_until(target, cpu_runs && !port_a.running() && cpu.asleep() ? watched : stops);
    stopped = motors.take_stop() || stopped;
    if (now == init_at) {
      init_at = kNever;
      init_holds = true;
      begin_reset(false);
    }
    if (now == reset_until) start_cpu();
    while (port_a.moving() && now == port_a.stands_at()) {
      port_a.step(inputs, board->outputs());
      board->set_port_a(inputs);
      if (port_a.strobe_moved()) port_a.board_follows(board->port_a_at_once());
    }
    run_cpu(now);
    if (signals.traced())  // a cycle is told when it is over, with the time at which it began
      signals.flush_until(port_a.running() ? std::min(tick_to_fs(now), port_a.started_at()) : tick_to_fs(now));
  }
  stop_on = {};
  if (sc_core::sc_is_running()) keep_kernel_time(begin);
  return now;
}

// Never past a tick at which the CPU could change the board's inputs.
Tick Machine::Impl::board_limit(Tick limit, Tick now) const {
  if (port_a.moving()) {
    if (port_a.stands_at() < now) throw std::logic_error("the board has run past an edge of the bus cycle under way");
    limit = std::min(limit, port_a.stands_at());
    if (port_a.running()) return limit;
  }
  if (!cpu_runs || cpu.asleep()) return limit;
  const Tick next = port_a.clock().tick(cpu.cycle()) - 1;
  return std::min(limit, aperture.on() ? next - 1 : next);  // an edge that may see its first move early
}

// Runs the CPU while every interrupt pin is known up to tick `known`: an instruction that starts at time t sees the
// edges up to t - latency, so it may start before known + 1 + latency.
void Machine::Impl::run_cpu(Tick known) {
  if (port_a.running()) return;
  if (master != nullptr && reset_until == kNever) return run_master();
  const CpuClock& clock = port_a.clock();
  while (cpu_runs && !port_a.running()) {
    if (!events.empty() && deliver_due()) continue;
    if (cpu.asleep()) return;
    Cycle limit = clock.first_cycle(known + 1 + kInterruptLatency);
    if (!events.empty()) limit = std::min(limit, clock.first_cycle(events.front().tick + kInterruptLatency));
    if (cpu.cycle() >= limit) return;
    if (debugger != nullptr)
      debugger->run(limit);
    else
      cpu.run(limit);
  }
}

// Finishes the access of the bus master and begins the next, all in the future of the board. When the CPU was in the
// middle of an access as the master came, that one is finished first and its result is nobody's.
void Machine::Impl::run_master() {
  const CpuClock& clock = port_a.clock();
  for (unsigned made = 0; !port_a.running() && made < 64; ++made) {
    const bool begin = !initiator.under_way();
    if (begin) {
      master_access = master->next();
      if (!master_access) return;
      aperture.take(master_access->early);
    }
    Cycle start = clock.first_cycle(board->now());
    if (clock.tick(start) == board->now()) ++start;  // begins with an edge that has been
    start = std::max(port_a.free_at(), start);
    while (std::max(aperture.first(clock.time(start)) - 1, port_a.stood_at()) < board->now())
      ++start;  // an edge that might have seen it has been
    if (begin) {
      start += master_access->idle;
      start += (master_access->slots + master_access->slot - clock.number(start) % master_access->slots) %
               master_access->slots;
      port_a.take_moving_ta(master_access->moving_ta);
    }
    const BusMaster::Access a = master_access.value_or(BusMaster::Access{});
    const std::uint32_t address = kPmacBase + 8 * a.address + (a.x ? 4 : 0);
    const DeviceBus::Result result = initiator.access(address, 4, a.write, a.data, start);
    if (!result.retry && master_access) master->done(a, result.data);
  }
}

// What the clock on the CPU's wall would show: the CPU may be ahead of the board, or asleep since long ago.
TimeFs Machine::Impl::cpu_time() const {
  const TimeFs board_time = tick_to_fs(board->now());
  return !cpu_runs || cpu.asleep() ? board_time : std::max(board_time, port_a.clock().time(cpu.cycle()));
}

// Gives the CPU the oldest pin change when its time has come; a sleeping CPU's time jumps there.
bool Machine::Impl::deliver_due() {
  const Cycle due = port_a.clock().first_cycle(events.front().tick + kInterruptLatency);
  if (cpu.cycle() < due) {
    if (!cpu.asleep()) return false;
    cpu.set_cycle(due);
  }
  const Event event = events.front();
  events.pop_front();
  switch (event.kind) {
    case Event::kPhase:
      cpu.set_interrupt(kIrqPhase, true);
      break;
    case Event::kServo:
      cpu.set_interrupt(kIrqServo, true);
      break;
    case Event::kHostPortOn:
      cpu.set_interrupt(kIrqHostPort, true);
      break;
    case Event::kHostPortOff:
      cpu.set_interrupt(kIrqHostPort, false);
      break;
    case Event::kStop:
      cpu_runs = false;
      break;
  }
  return true;
}

// Inside a SystemC process the kernel's time follows the board's as far as its 64 bits go, 213 days of picoseconds;
// then it stands still, which no part of the machine sees.
void Machine::Impl::keep_kernel_time(Tick from) {
  const auto process = sc_core::sc_get_current_process_handle();
  if (!process.valid() || process.proc_kind() != sc_core::SC_THREAD_PROC_) return;
  using Units = sc_core::sc_time::value_type;
  static const TimeFs kUnit = std::llround(sc_core::sc_get_time_resolution().to_seconds() * 1e15);
  constexpr TimeFs kLast = std::numeric_limits<Units>::max() - 1;
  const TimeFs kernel = sc_core::sc_time_stamp().value();
  if (!kernel_offset) kernel_offset = kernel * kUnit - tick_to_fs(from);
  const TimeFs target = std::min(kLast, (*kernel_offset + tick_to_fs(board->now()) + kUnit / 2) / kUnit);
  if (target > kernel) sc_core::wait(sc_core::sc_time::from_value(static_cast<Units>(target - kernel)));
}

}  // namespace brick
