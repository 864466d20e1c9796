// Run control: when the program stops, and what a step is.
#include "systemc/cpu/gdb_server.h"

#include <algorithm>
#include <utility>

#include "systemc/cpu/decode.h"
#include "systemc/cpu/gdb_hex.h"
#include "systemc/cpu/gdb_state.h"

namespace brick {

namespace {

constexpr unsigned kStackPointer = 2;
// GDB's numbers of signals.
constexpr unsigned kSigInt = 2, kSigIll = 4, kSigTrap = 5, kSigBus = 10, kSigSegv = 11, kSigSys = 12;
constexpr unsigned kMcause = 0x342;
constexpr std::uint32_t kInterrupt = 0x8000'0000;
constexpr auto kLookEvery = std::chrono::milliseconds(5);
constexpr unsigned kInstructionsPerLook = 1024;
constexpr Cycle kCyclesPerLook = 100'000;

unsigned signal_of(std::uint32_t cause) {
  switch (cause) {
    case 2:
      return kSigIll;
    case 3:
      return kSigTrap;
    case 4:
    case 6:  // misaligned
      return kSigBus;
    case 11:
      return kSigSys;
    default:
      return kSigSegv;
  }
}

struct DataAccess {
  bool write = false;
  std::uint32_t address = 0, bytes = 0;  // none: 0 bytes
};

// What the instruction at pc is going to load or store.
DataAccess data_access(Cpu& cpu) {
  using cpu::Op;
  std::uint32_t word = 0;
  for (unsigned i = 0; i < 2; ++i) {
    const std::uint8_t* half = cpu.memory(cpu.pc() + 2 * i, 2);
    if (half == nullptr) return {};
    word |= (half[0] | static_cast<std::uint32_t>(half[1]) << 8) << 16 * i;
    if (cpu::is_compressed(word)) break;
  }
  const cpu::Decoded d = cpu::decode(word, cpu.pc());
  const auto access = [&](bool write, std::uint32_t bytes) {
    return DataAccess{write, cpu.reg(d.rs1) + static_cast<std::uint32_t>(d.imm), bytes};
  };
  switch (d.op) {
    case Op::kLw:
    case Op::kCLw:
      return access(false, 4);
    case Op::kLh:
    case Op::kLhu:
      return access(false, 2);
    case Op::kLb:
    case Op::kLbu:
      return access(false, 1);
    case Op::kSw:
    case Op::kCSw:
      return access(true, 4);
    case Op::kSh:
      return access(true, 2);
    case Op::kSb:
      return access(true, 1);
    default:
      return {};
  }
}

}  // namespace

Cpu::Stop GdbServer::Impl::run(Cycle limit) {
  while (cpu.cycle() < limit) {
    if (!stepwise() || ++since_look >= kInstructionsPerLook) look();
    if (!cpu.access_waits()) before_instruction();
    const Cpu::Stop why = stepwise() ? one_instruction() : cpu.run(std::min(limit, cpu.cycle() + kCyclesPerLook));
    if (why != Cpu::Stop::kLimit) return why;
  }
  return Cpu::Stop::kLimit;
}

// Exactly one instruction, or the entry into one trap handler, or a part of a device access.
Cpu::Stop GdbServer::Impl::one_instruction() {
  const std::uint32_t pc = cpu.pc();
  const std::uint64_t count = cpu.instructions();
  const DataAccess access = watches.empty() ? DataAccess{} : data_access(cpu);
  const Cpu::Stop why = cpu.run(cpu.cycle() + 1);
  if (cpu.instructions() == count) {
    const bool interrupt = !cpu.access_waits() && cpu.pc() != pc && (cpu.csr(kMcause) & kInterrupt) != 0;
    if (stepping && interrupt && count == resume_count && pc == resume_pc) in_handler = true;
    return why;
  }
  for (const Watch& w : watches) {
    if (access.bytes == 0 || w.kind == (access.write ? Kind::kRead : Kind::kWrite)) continue;
    // Distances, because a range may end at the end of the address space.
    if (access.address - w.address >= w.bytes && w.address - access.address >= access.bytes) continue;
    watch_hit = w.kind == Kind::kWrite ? "watch:" : w.kind == Kind::kRead ? "rwatch:" : "awatch:";
    const std::uint32_t at = access.address - w.address < w.bytes ? access.address : w.address;
    for (unsigned shift = 32; shift > 0; shift -= 8)
      gdb::put_byte(watch_hit, static_cast<std::uint8_t>(at >> (shift - 8)));
    watch_hit += ';';
    break;
  }
  return why;
}

void GdbServer::Impl::before_instruction() {
  if (waiting) {
    waiting = false;
    link.accept();
    serve();
  }
  // Again after each stop: the debugger may have moved pc onto another breakpoint.
  while (true) {
    const std::string reason = stop_reason();
    if (reason.empty()) return;
    stop(reason);
  }
}

std::string GdbServer::Impl::stop_reason() {
  if (pending != Pending::kNone) {
    const Pending why = std::exchange(pending, Pending::kNone);
    if (why == Pending::kAttach) return "attach";
    std::string text = "T";
    gdb::put_byte(text, static_cast<std::uint8_t>(why == Pending::kSignal ? signal : kSigInt));
    return text + "thread:1;";
  }
  if (!watch_hit.empty()) {
    std::string hit;
    hit.swap(watch_hit);
    return trap_reason(hit);
  }
  const std::uint32_t pc = cpu.pc();
  const bool moved = cpu.instructions() != resume_count || pc != resume_pc;
  if (moved && breakpoints[0].count(pc) != 0) return trap_reason("swbreak:;");
  if (moved && breakpoints[1].count(pc) != 0) return trap_reason("hwbreak:;");
  if (!stepping) return {};
  if (in_handler) {
    if (pc != resume_pc || cpu.reg(kStackPointer) != step_sp) return {};
    in_handler = false;  // back where the step began: now it is made
    resume_count = cpu.instructions();
    return {};
  }
  return moved ? trap_reason("") : "";
}

// Looks at the connection, not too often: it is a system call.
void GdbServer::Impl::look() {
  since_look = 0;
  const auto now = std::chrono::steady_clock::now();
  if (waiting || now - last_look < kLookEvery) return;
  last_look = now;
  if (!link.connected()) {
    if (link.try_accept()) pending = Pending::kAttach;
    return;
  }
  if (link.interrupted()) pending = Pending::kBreak;
  if (!link.connected()) detach();
}

void GdbServer::Impl::stop(const std::string& reason) {
  stepping = in_handler = false;
  if (reason == "attach") {
    last_stop = trap_reason("");  // told when the new debugger asks
  } else {
    if (!console.empty()) link.send("O" + gdb::encode(std::exchange(console, {})));
    last_stop = reason;
    link.send(reason);
  }
  serve();
}

// Answers packets until one resumes the program or the debugger goes.
void GdbServer::Impl::serve() {
  resumed = stop_owed = false;
  while (!resumed) {
    const auto packet = link.receive();
    if (!packet) return detach();
    const auto reply = packet->too_long ? std::string("E01") : answer(packet->data);
    if (reply) link.send(*reply);
  }
}

void GdbServer::Impl::detach() {
  link.close();
  breakpoints[0].clear();
  breakpoints[1].clear();
  watches.clear();
  watch_hit.clear();
  console.clear();
  pending = Pending::kNone;
  stepping = in_handler = stop_owed = false;
  resumed = true;
}

void GdbServer::Impl::raise(unsigned number, const std::string& text) {
  if (!link.connected()) return;
  pending = Pending::kSignal;
  signal = number;
  console += text + "\n";
}

GdbServer::GdbServer(Cpu& cpu, std::uint16_t port) : impl_(std::make_unique<Impl>(cpu, port)) {
  cpu.stop_at_exceptions(true);
}

GdbServer::~GdbServer() {
  impl_->cpu.stop_at_exceptions(false);
  if (impl_->link.connected() && impl_->stop_owed) impl_->link.send("W00");
}

std::uint16_t GdbServer::port() const { return impl_->link.port(); }

Cpu::Stop GdbServer::run(Cycle limit) {
  impl_->on_time = on_time;
  return impl_->run(limit);
}

void GdbServer::bus_error(const std::string& text) { impl_->raise(kSigBus, text); }

void GdbServer::exception(std::uint32_t cause, const std::string& text) { impl_->raise(signal_of(cause), text); }

void GdbServer::poll(bool idle) {
  impl_->look();
  if (idle && impl_->pending != Impl::Pending::kNone) {
    impl_->on_time = on_time;
    impl_->stop(impl_->stop_reason());
  }
}

}  // namespace brick
