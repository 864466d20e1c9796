// The whole controller: its parts, how they are joined, reset and power. The run-ahead rule is in run.cpp.
#include "systemc/machine/machine.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "systemc/cosim/engines.h"
#include "systemc/machine/board_family.h"
#include "systemc/machine/machine_impl.h"

namespace brick {

namespace {

constexpr std::size_t kBusCyclesKept = 16;

std::unique_ptr<Board> make_board(const MachineConfig& c) {
  const std::uint32_t fitted = c.board.fitted;
  const RtlOptions rtl{c.seed, c.seeded_bug};
  switch (c.engine) {
    case Engine::kRtl:
      return make_rtl_board(fitted, rtl);
    case Engine::kSystemC:
      return make_model_board(fitted, c.seed);
    case Engine::kLockstep:
      break;
  }
  return make_lockstep_board(make_rtl_board(fitted, rtl), make_model_board(fitted, c.seed));
}

std::unique_ptr<Board> wired(const MachineConfig& c, std::unique_ptr<Board> board) {
  return c.rewire ? c.rewire(std::move(board)) : std::move(board);
}

Straps straps(const BoardConfig& board) {
  Straps s;
  s.fitted = board.fitted;
  s.macro_gate = static_cast<std::uint8_t>(board.macro_gate);
  s.dpram_small = board.dpram_words < 32768;
  s.jpan_fitted = board.jpan;
  s.line_select = static_cast<std::uint16_t>(board.line_select);
  s.pic_8259 = board.pic_8259;
  s.ssi_kind = board.ssi_kind;
  return s;
}

bool has_ssi_page(const BoardConfig& board) { return (board.ssi_kind & kSsiGeoPmac) != 0; }

IsaStraps isa_straps(const BoardConfig& board) {
  IsaStraps s;
  s.io_base = static_cast<std::uint8_t>(board.io_base >> 4);
  s.io_decode16 = board.io_decode16;
  s.window = static_cast<std::uint16_t>(board.window >> 14);
  s.window_flat = board.window_flat;
  s.slot8 = board.slot8;
  return s;
}

PciBridge::Local pci_local(const BoardConfig& board) { return {board.io_base, board.window, 2 * board.dpram_words}; }

constexpr std::uint32_t kInterrupt = 0x8000'0000;  // in mcause

std::uint32_t trap_handler(const Cpu& cpu, std::uint32_t cause) {
  constexpr unsigned kMtvec = 0x305;
  const std::uint32_t vector = cpu.csr(kMtvec);
  const bool vectored = (vector & 1) != 0 && (cause & kInterrupt) != 0;
  return (vector & ~3u) + (vectored ? 4 * (cause & ~kInterrupt) : 0);
}

}  // namespace

PortAInitiator::PortAInitiator(sc_core::sc_module_name name, PortA& port_a)
    : sc_core::sc_module(name), port_a_(port_a) {
  socket.bind(port_a.socket);
  payload_.set_extension(&request_);
  payload_.set_data_ptr(reinterpret_cast<unsigned char*>(&data_));
}

PortAInitiator::~PortAInitiator() { payload_.clear_extension(&request_); }

DeviceBus::Result PortAInitiator::access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data,
                                         Cycle now) {
  if (!under_way_) {
    data_ = write ? data : 0;
    payload_.set_address(address);
    payload_.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
    payload_.set_data_length(bytes);
    payload_.set_streaming_width(bytes);
    payload_.set_byte_enable_ptr(nullptr);
    payload_.set_dmi_allowed(false);
    request_.start = now;
    request_.pc = by_master ? 0 : cpu->pc();
  }
  payload_.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  // Through the export: it works before elaboration too, so a machine needs no running kernel.
  static_cast<sc_core::sc_export<tlm::tlm_fw_transport_if<>>&>(port_a_.socket)->b_transport(payload_, delay);
  under_way_ = payload_.get_response_status() == tlm::TLM_INCOMPLETE_RESPONSE;
  return {payload_.get_response_status() < 0, data_, request_.done, under_way_};
}

Machine::Impl::Impl(Machine& machine, const MachineConfig& machine_config)
    : config(machine_config),
      jumper_e3(config.jumper_e3),
      owner(machine),
      board(wired(config, make_board(config))),
      motors(*board, signals, config.board.fitted, brick::idle_channel_pins(config.board)),
      aperture(config.aperture, config.seed),
      memory(cpu, config.flash_file, has_ssi_page(config.board)) {
  initiator.cpu = &cpu;
  if (config.board.bus == "pci") pci = std::make_unique<PciBridge>("pci_bridge", pci_local(config.board));
  if (!config.firmware.empty()) elf = std::make_unique<ElfFile>(config.firmware);
  board->on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    board_changed(t, before, after);
  };
  port_a.set_aperture(&aperture);
  if (config.skew) port_a.set_skew(PinSkew(config.seed));
  port_a.seed(config.seed);
  if (config.bcr) port_a.force_wait_states(*config.bcr);
  port_a.on_cycle = [this](const PortACycle& c) { cycle_done(c); };
  port_a.on_control = [this] { main_memory_wait(); };
  cpu.on_trap = [this](std::uint32_t cause, std::uint32_t pc, Cycle c) {
    const TimeFs time = port_a.clock().time(c);
    if ((cause & kInterrupt) == 0) exception(cause, pc, time);
    named.trap(time, cause);
    if (owner.on_task) owner.on_task(time);
    if (tracing_cpu) named.pc(time, trap_handler(cpu, cause), elf.get());
  };
  cpu.on_mret = [this](std::uint32_t pc, Cycle c) {
    const TimeFs time = port_a.clock().time(c);
    named.trap_return(time);
    if (owner.on_task) owner.on_task(time);
    if (tracing_cpu) named.pc(time, pc, elf.get());
  };
  memory.on_saved = [this] { keep_flash(); };
  static_cast<Straps&>(host_inputs) = straps(config.board);
  static_cast<IsaStraps&>(host_inputs) = isa_straps(config.board);
  static_cast<HostInputs&>(inputs) = host_inputs;
  named.outputs(0, {}, board->outputs());
  power_on();
}

Machine::Impl::~Impl() { keep_flash(); }

// Whoever cannot write the file is told at once, and the run fails; the controller goes on. A run may last for days:
// the same failure at each SAVE is kept once.
void Machine::Impl::keep_flash() {
  try {
    memory.save_flash();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    if (std::find(run_errors.begin(), run_errors.end(), e.what()) == run_errors.end())
      run_errors.emplace_back(e.what());
  }
}

void Machine::Impl::exception(std::uint32_t cause, std::uint32_t pc, TimeFs time) {
  constexpr unsigned kMtval = 0x343, kReturnAddress = 1;
  const CpuFault fault{cause, cpu.csr(kMtval), pc, cpu.reg(kReturnAddress), time};
  faults.add(fault);
  if (debugger != nullptr) debugger->exception(cause, "exception of the CPU: " + fault_text(fault, elf.get()));
}

void Machine::Impl::power_on() {
  memory.randomize(config.seed + power_ons++);
  if (pci) pci->reset();
  memory.set_strap(MachineMemory::Strap::kJumperE3, jumper_e3);
  memory.set_strap(MachineMemory::Strap::kFitted, config.board.fitted);
  memory.set_strap(MachineMemory::Strap::kCard, config.board.card);
  memory.set_strap(MachineMemory::Strap::kDpramWords, config.board.dpram_words);
  memory.set_strap(MachineMemory::Strap::kProduct, config.board.product | (config.board.jpan ? 1u : 0u));
  if (elf) elf->load(cpu);
  begin_reset(true);
}

void Machine::Impl::begin_reset(bool power) {
  memory.set_strap(MachineMemory::Strap::kPowerOn, power);
  reset_until = init_holds ? kNever : board->now() + kResetTicks;
  cpu_runs = false;
  events.clear();
  initiator.forget();
  master_access.reset();
  aperture.take({});
  clock_drivers.reset();
  port_a.reset(board->now(), cpu.cycle(), inputs);
  inputs.rst_n = false;
  board->set_inputs(inputs);
  named.restart(tick_to_fs(board->now()));
  host_bus_moved(tick_to_fs(board->now()));
}

void Machine::Impl::start_cpu() {
  reset_until = kNever;
  inputs.rst_n = true;
  port_a.reset(board->now(), cpu.cycle(), inputs);
  board->set_inputs(inputs);
  events.clear();
  main_memory_wait();
  cpu.reset(elf ? elf->entry() : 0);
  cpu_runs = elf != nullptr && master == nullptr;
  host_bus_moved(tick_to_fs(board->now()));
}

void Machine::Impl::board_changed(Tick tick, const BoardOutputs& before, const BoardOutputs& after) {
  static constexpr BoardOutputs kHostBus =
      select_pins(pin::kIsaSd, pin::kIsaSdOe, pin::kIsaIochrdy, pin::kIsaMemcs16N, pin::kTxde);
  static constexpr BoardOutputs kPortA = select_pins(pin::kPaData, pin::kPaDataOe, pin::kPaTaN);
  static constexpr BoardOutputs kSeenByCpu = select_pins(pin::kPhase, pin::kServo, pin::kIrqHost, pin::kWdTripped);
  named.outputs(tick_to_fs(tick), before, after);
  if (before.differs(after, kPortA)) port_a.board_changed(tick, after);
  if (const std::uint32_t ssi = before.get(pin::kSsiClk), clk = after.get(pin::kSsiClk); ssi != clk)
    motors.ssi_clocked(tick, static_cast<std::uint8_t>(ssi), static_cast<std::uint8_t>(clk));
  if (owner.on_outputs) owner.on_outputs(tick, before, after);
  if (before.differs(after, kHostBus)) host_bus_moved(tick_to_fs(tick));
  if (before.differs(after, stop_on)) stopped = true;
  if (before.get(pin::kSourceConflict) == 0 && after.get(pin::kSourceConflict) != 0) {
    if (!inputs.pa_wr_n)
      clock_drivers.write(inputs.pa_x, inputs.pa_addr, inputs.pa_wdata);  // the cycle under way may be the cause
    run_errors.push_back(clock_drivers.contention(tick, inputs.fitted, inputs.ext_clock));
  }
  if (!cpu_runs || !before.differs(after, kSeenByCpu)) return;
  const auto fell = [&](const PinField& f) { return before.get(f) != 0 && after.get(f) == 0; };
  const auto rose = [&](const PinField& f) { return before.get(f) == 0 && after.get(f) != 0; };
  if (fell(pin::kPhase)) events.push_back({tick, Event::kPhase});
  if (fell(pin::kServo)) events.push_back({tick, Event::kServo});
  if (rose(pin::kIrqHost)) events.push_back({tick, Event::kHostPortOn});
  if (fell(pin::kIrqHost)) events.push_back({tick, Event::kHostPortOff});
  if (rose(pin::kWdTripped)) events.push_back({tick, Event::kStop});
}

void Machine::Impl::cycle_done(const PortACycle& c) {
  if (bus_cycles.size() >= 4 * kBusCyclesKept) bus_cycles.erase(bus_cycles.begin(), bus_cycles.end() - kBusCyclesKept);
  bus_cycles.push_back({fs_to_tick(c.start), c.x ? 'X' : 'Y', c.address, c.write, c.data, c.pc});
  if (c.write) clock_drivers.write(c.x, c.address, c.data);
  if (tracing_cpu) named.pc(c.start, c.pc, elf.get());
  if (owner.check_bus_cycle) owner.check_bus_cycle(c);
  if (owner.on_bus_cycle) owner.on_bus_cycle(c);
}

void Machine::Impl::trace_cpu(bool on) {
  tracing_cpu = on;
  cpu.on_flow = nullptr;
  if (!on) return;
  cpu.on_flow = [this](std::uint32_t pc, Cycle c) { named.pc(port_a.clock().time(c), pc, elf.get()); };
}

void Machine::Impl::take_host_inputs() {
  static_cast<HostInputs&>(inputs) = host_inputs;
  board->set_inputs(inputs);
}

void Machine::Impl::apply_host_inputs(TimeFs time) {
  host_moves = false;
  take_host_inputs();
  named.inputs(tick_to_fs(board->now()), inputs, board->outputs());
  host_bus_moved(time);
  // Pins of Port A that a program moves itself; a bus master says what has come to it.
  if (port_a_watch != nullptr && !elf && master == nullptr) port_a_watch->board_moved(time, board->port_a_at_once());
  if (config.board.jpan) see_init();
}

// What absolute encoders show. Their pins are nobody else's, so nothing of the host moves.
void Machine::Impl::drive_ssi() {
  host_inputs.ssi_data = inputs.ssi_data = motors.ssi_data();
  board->set_inputs(inputs);
  named.inputs(tick_to_fs(board->now()), inputs, board->outputs());
}

// While a move of the host is in doubt the board has a part of it; outside nothing moves before the host says when.
void Machine::Impl::host_bus_moved(TimeFs time) {
  if (owner.on_host_bus && !host_moves) owner.on_host_bus(time, inputs, board->outputs());
}

// The card's reset circuit: INIT/ pulls the reset line after kInitTicks and as long as it is low, and kResetTicks more.
void Machine::Impl::see_init() {
  const bool low = !host_inputs.jpan_init_n;
  if (low == init_low) return;
  init_low = low;
  init_at = low ? board->now() + kInitTicks : kNever;
  if (low || !init_holds) return;
  init_holds = false;
  reset_until = board->now() + kResetTicks;
}

Machine::Machine(sc_core::sc_module_name name, const MachineConfig& config)
    : sc_core::sc_module(name), impl_(std::make_unique<Impl>(*this, config)) {}
Machine::~Machine() = default;

Tick Machine::now() const { return impl_->board->now(); }
Tick Machine::run_until(Tick limit, const BoardOutputs& stop_on) { return impl_->run_until(limit, stop_on); }
HostInputs& Machine::inputs() { return impl_->host_inputs; }
void Machine::apply_partly() {
  impl_->host_moves = true;
  impl_->take_host_inputs();
}
void Machine::apply(TimeFs time) { impl_->apply_host_inputs(time); }
PortAPins& Machine::port_a() { return impl_->inputs; }
const BoardOutputs& Machine::outputs() const { return impl_->board->outputs(); }
BoardOutputs Machine::port_a_at_once() const { return impl_->board->port_a_at_once(); }
TimeFs Machine::cpu_period() const {
  const CpuClock& clock = impl_->port_a.clock();
  return tick_to_fs(CpuClock::kTicksPerMultiplier) / clock.multiplier();
}
bool Machine::forced_bcr_acted() const { return impl_->port_a.forced_wait_states_acted(); }
std::uint32_t Machine::fitted() const { return impl_->config.board.fitted; }
MotorInputPins& Machine::motor_inputs() { return impl_->motors.inputs(); }
std::uint16_t Machine::driven_motor_inputs(unsigned ic, unsigned channel) const {
  return impl_->motors.driven(ic, channel);
}
std::uint16_t Machine::idle_channel_pins() const { return impl_->motors.idle_pins(); }
void Machine::apply_motor_inputs() { impl_->motors.apply(); }
MotorOutputs Machine::motor_outputs(unsigned ic) const { return impl_->board->motor_outputs(ic); }
void Machine::stop_on_motor(unsigned ic, const MotorOutputs& select) { impl_->motors.stop_on(ic, select); }
void Machine::attach(MotorPeer& peer) { impl_->motors.attach(peer); }
void Machine::detach(MotorPeer& peer) { impl_->motors.detach(peer); }
const PinSkew& Machine::skew() const { return impl_->port_a.skew(); }
Aperture& Machine::aperture() { return impl_->aperture; }
Cpu& Machine::cpu() { return impl_->cpu; }
std::uint64_t Machine::instructions() const { return impl_->cpu.instructions(); }

void Machine::attach_debugger(GdbServer* debugger) {
  impl_->debugger = debugger;
  if (debugger == nullptr) return;
  debugger->on_time = [this] { return std::to_string(fs_to_ns(impl_->cpu_time())) + " ns"; };
}

void Machine::attach_bus_master(BusMaster* master) {
  impl_->master = master;
  impl_->initiator.by_master = master != nullptr;
  if (master != nullptr)
    impl_->cpu_runs = false;
  else
    impl_->aperture.take({});
}
void Machine::attach_port_a_watch(PortAWatch* watch) {
  impl_->port_a_watch = watch;
  impl_->port_a.set_watch(watch);
}
std::string Machine::function_at(std::uint32_t pc) const { return impl_->elf ? impl_->elf->symbol_at(pc) : ""; }
std::string Machine::cpu_place() const { return place_in_code(impl_->elf.get(), impl_->cpu.pc()); }
std::string Machine::last_exception() const { return impl_->faults.last(impl_->elf.get()); }
unsigned Machine::task() const { return impl_->named.task(); }

void Machine::reset() { impl_->begin_reset(false); }
void Machine::set_jumper_e3(bool on) {
  impl_->jumper_e3 = on;
  impl_->memory.set_strap(MachineMemory::Strap::kJumperE3, on);
}
const std::vector<Machine::BusCycle>& Machine::last_bus_cycles() const { return impl_->bus_cycles; }

std::vector<std::string> Machine::run_errors() const {
  std::vector<std::string> errors = impl_->run_errors;
  for (std::string& text : impl_->faults.texts(impl_->elf.get())) errors.push_back(std::move(text));
  return errors;
}
std::vector<std::string> Machine::take_run_errors() {
  std::vector<std::string> errors = run_errors();
  impl_->run_errors.clear();
  impl_->faults.clear();
  return errors;
}

PciBridge* Machine::pci() { return impl_->pci.get(); }

Signals& Machine::signals() {
  // Unless a waveform wants it nobody follows each call: what is asked for now is what stands now.
  if (!impl_->named.traces_pc()) impl_->named.pc(now_fs(), impl_->cpu.pc(), impl_->elf.get());
  return impl_->signals;
}

void Machine::power_cycle() {
  impl_->keep_flash();
  impl_->power_on();
}

}  // namespace brick
