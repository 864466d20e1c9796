// The CPU's public face: mapping, state and interrupt pins. Execution is in execute.cpp.
#include "systemc/cpu/cpu.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "systemc/cpu/cpu_state.h"

namespace brick {

using namespace cpu;

Cpu::Cpu(DeviceBus* devices) : s_(std::make_unique<State>(*this, devices)) {}
Cpu::~Cpu() = default;

void Cpu::State::check_free(std::uint32_t base, std::uint32_t bytes) const {
  if (bytes == 0 || base % 4 != 0 || bytes % 4 != 0)
    throw std::invalid_argument("Cpu::map: a region consists of whole words");
  if (bytes - 1 > UINT32_MAX - base)
    throw std::invalid_argument("Cpu::map: region passes the end of the address space");
  for (const Region& r : regions) {
    if (r.holds(base, 1) || (base <= r.base && r.base - base < bytes))
      throw std::invalid_argument("Cpu::map: regions overlap");
  }
}

std::uint8_t* Cpu::map(std::uint32_t base, std::uint32_t bytes, RegionOptions options) {
  s_->check_free(base, bytes);
  Region region{base, bytes, options, {}};
  region.data.reset(static_cast<std::uint8_t*>(std::calloc(bytes, 1)));
  if (region.data == nullptr) throw std::bad_alloc();
  s_->regions.push_back(std::move(region));
  s_->forget_translations();
  return s_->regions.back().data.get();
}

void Cpu::share(std::uint32_t base, std::uint32_t bytes, const std::uint8_t* data) {
  s_->check_free(base, bytes);
  // Nothing of the CPU writes to a region that is read only.
  s_->regions.push_back({base, bytes, {true, false, 0}, {const_cast<std::uint8_t*>(data), FreeOwned{false}}});
  s_->forget_translations();
}

void Cpu::set_wait(std::uint32_t base, Cycle wait) {
  for (Region& r : s_->regions) {
    if (r.base == base) r.options.wait = wait;
  }
  s_->forget_translations();
}

std::uint8_t* Cpu::memory(std::uint32_t address, std::uint32_t bytes) {
  Region* r = s_->find(address, bytes);
  return r == nullptr ? nullptr : r->data.get() + (address - r->base);
}

void Cpu::invalidate_code() { s_->invalidate_code(); }

std::vector<Cpu::Mapping> Cpu::mappings() const {
  std::vector<Mapping> list;
  for (const Region& r : s_->regions) list.push_back({r.base, r.bytes, r.options.mask24});
  return list;
}

std::vector<std::uint32_t> Cpu::executed() const {
  std::set<std::uint32_t> all = s_->executed;
  s_->add_decoded(all);
  return {all.begin(), all.end()};
}

void Cpu::reset(std::uint32_t pc) {
  if (on_reset) on_reset();
  State& s = *s_;
  s.x.fill(0);
  s.pc = pc & ~1u;
  s.sleeping = s.access_waits = false;
  s.interrupts_on = s.interrupts_were = false;
  s.mie = s.mip = s.mtvec = s.mepc = s.mcause = s.mtval = s.mscratch = 0;
  s.mcycle_offset = 0 - static_cast<std::uint64_t>(s.cycle);
  s.minstret_offset = 0 - s.retired;
}

std::uint32_t Cpu::pc() const { return s_->pc; }
void Cpu::set_pc(std::uint32_t pc) { s_->pc = pc & ~1u; }
std::uint32_t Cpu::reg(unsigned i) const { return s_->x.at(i); }

void Cpu::set_reg(unsigned i, std::uint32_t v) {
  if (i != 0) s_->x.at(i) = v;
}

std::uint32_t Cpu::csr(unsigned number) const {
  std::uint32_t v = 0;
  s_->read_csr(number, v);
  return v;
}

Cycle Cpu::cycle() const { return s_->cycle; }
void Cpu::set_cycle(Cycle c) {
  s_->slept += c - s_->cycle;
  s_->cycle = c;
}
Cycle Cpu::slept() const { return s_->slept; }
std::uint64_t Cpu::instructions() const { return s_->retired; }
bool Cpu::asleep() const { return s_->sleeping; }
bool Cpu::access_waits() const { return s_->access_waits; }

// An instruction takes a cycle or more, so each run to the next cycle executes one.
Cpu::Stop Cpu::run(Cycle limit) {
  if (!on_instruction) return execute(limit);
  for (;;) {
    const std::uint32_t at = pc();
    const Cycle begin = cycle();
    const Stop stop = execute(std::min(limit, begin + 1));
    if (cycle() != begin) on_instruction(at, cycle() - begin);
    if (stop != Stop::kLimit || cycle() >= limit) return stop;
  }
}

void Cpu::set_interrupt(CpuInterrupt line, bool pending) {
  State& s = *s_;
  s.mip = (s.mip & ~(1u << line)) | (pending ? 1u << line : 0);
  if ((s.mip & s.mie) != 0) s.sleeping = false;
}

void Cpu::stop_at_exceptions(bool stop) { s_->stops_at_exceptions = stop; }

void Cpu::watch_store(std::uint32_t address) {
  s_->watched.push_back(address & ~3u);
  s_->forget_translations();
}

}  // namespace brick
