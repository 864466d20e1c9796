#include "systemc/host/dpram.h"

#include "systemc/core/register_access.h"

namespace brick {

Dpram::Dpram(const sc_core::sc_module_name& name) : sc_module(name), socket("socket") {
  socket.register_b_transport(this, &Dpram::b_transport);
}

bool Dpram::cpu_idle() const {
  const bool rd = in.cpu_sel && !in.cpu_rd_n, wr = in.cpu_sel && !in.cpu_wr_n;
  if (rd != cpu_rd_ || wr != cpu_wr_) return false;
  if (!cpu_active()) return !cpu_done_ && !cpu_busy_;
  return cpu_done_ || (cpu_busy_ && cpu_blocked());
}

bool Dpram::host_idle() const {
  if (in.mem_wr && host_own_) return false;
  if (!in.mem_sel) return !host_own_ && !mem_busy_;
  return host_own_ || (mem_busy_ && host_blocked());
}

Tick Dpram::next_event() const {
  if (!cpu_idle()) return now_ + 1;
  return host_idle() ? kNever : next_ref_edge(now_);
}

void Dpram::advance(Tick t) {
  for (Tick edge = next_event(); edge <= t; edge = next_event()) {
    now_ = edge;
    // Both decisions come from the state before the edge. Of the cells that are then touched no one is touched twice.
    const bool block_cpu = cpu_blocked(), block_host = host_blocked();
    if (is_ref_edge(edge)) host_edge(block_host);
    cpu_edge(block_cpu);
  }
  now_ = t;
}

void Dpram::cpu_edge(bool blocked) {
  if (!cpu_active()) {
    cpu_done_ = cpu_busy_ = false;
    cpu_cell_ = static_cast<std::uint16_t>((in.cpu_addr & 0x3FFF) << 1 | (in.cpu_x ? 1 : 0));
  } else if (!cpu_done_) {
    cpu_busy_ = blocked;
    cpu_done_ = !blocked;
    if (cpu_done_ && cpu_rd_) cpu_rdata_ = peek(cpu_cell_);
    if (cpu_done_ && cpu_wr_) poke(cpu_cell_, in.cpu_wdata);
  }
  cpu_rd_ = in.cpu_sel && !in.cpu_rd_n;
  cpu_wr_ = in.cpu_sel && !in.cpu_wr_n;
}

void Dpram::host_write() {
  const unsigned lanes = ((in.mem_be & 1) ? 0x00FFu : 0u) | ((in.mem_be & 2) ? 0xFF00u : 0u);
  poke(in.mem_addr, static_cast<std::uint16_t>((peek(in.mem_addr) & ~lanes) | (in.mem_wdata & lanes)));
}

void Dpram::host_edge(bool blocked) {
  if (in.mem_wr && host_own_) host_write();
  if (!in.mem_sel) {
    host_own_ = mem_busy_ = false;
  } else if (!host_own_) {
    host_own_ = !blocked;
    mem_busy_ = blocked;
    if (host_own_ && in.mem_rd) mem_rdata_ = peek(in.mem_addr);
  }
}

// A write that was granted but not made yet is lost; the memory keeps its content. The host's is made from the first
// tick of its clk_ref on.
void Dpram::reset(Tick t) {
  if (in.mem_wr && host_own_ && !is_ref_edge(now_)) host_write();
  cpu_rd_ = cpu_wr_ = cpu_done_ = cpu_busy_ = host_own_ = mem_busy_ = false;
  cpu_cell_ = cpu_rdata_ = mem_rdata_ = 0;
  now_ = t;
}

void Dpram::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  if (!check_payload(payload, 2, 2 * fitted())) return;
  const Tick edge = catch_up(*this, now_, delay);
  const auto index = static_cast<unsigned>(payload.get_address() / 2);
  if (payload.is_read())
    set_payload_value(payload, peek(index));
  else
    poke(index, payload_value<std::uint16_t>(payload));
  delay = delay_until(edge);
}

}  // namespace brick
