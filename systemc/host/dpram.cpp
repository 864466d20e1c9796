#include "systemc/host/dpram.h"

#include <algorithm>

namespace brick {

// One more tick would change nothing.
bool Dpram::cpu_settled() const {
  const auto still = [](const Strobe& s, std::uint8_t falls, bool strobe_n) {
    return s.falls1 == falls && s.falls2 == falls && s.falls3 == falls && s.low1 == !strobe_n && s.low2 == !strobe_n;
  };
  const auto follows = [this](const Strobe& s) { return s.pending() && s.vain(sel_); };
  if (rd_.acknowledged != rd_.done) return false;  // of a write nobody waits for it
  if (!still(rd_, in.rd_falls, in.cpu_rd_n) || !still(wr_, in.wr_falls, in.cpu_wr_n)) return false;
  if (sel_ != in.cpu_sel || pins_ != pin_cell() || sampled_ || proven_) return false;
  if (follows(rd_) || follows(wr_)) return false;
  if (rd_.pending() || wr_.pending()) return request() && cpu_busy_ && cpu_blocked();
  return !cpu_busy_ && !(own_ && released());
}

bool Dpram::host_settled() const {
  if (in.mem_wr && host_own_) return false;
  if (!in.mem_sel) return !host_own_ && !mem_busy_;
  return host_own_ || (mem_busy_ && host_blocked());
}

Tick Dpram::next_event() const {
  if (!others() && !cpu_settled()) return now_ + 1;
  return host_settled() ? kNever : next_ref_edge(now_);
}

void Dpram::advance(Tick t) {
  while (now_ < t) {
    const Tick edge = next_event(), before = std::min(edge - 1, t);
    if (others()) let_others_pass(before - now_);
    now_ = before;
    if (edge > t) break;
    now_ = edge;
    // Both decisions come from the state before the edge. They never let both sides at one word of which one writes.
    const bool block_cpu = cpu_blocked(), block_host = host_blocked();
    if (is_ref_edge(edge)) host_edge(block_host);
    cpu_edge(block_cpu);
    cpu_pins();
  }
}

// Nothing of them but their way through the stages, which is five edges long: not selected, a strobe is done when the
// last of them shows it.
void Dpram::let_others_pass(Tick count) {
  constexpr Tick kEdges = 5;
  if (count >= kEdges) {
    const auto arrive = [](Strobe& s, std::uint8_t falls, bool strobe_n) {
      s.falls1 = s.falls2 = s.falls3 = s.done = s.acknowledged = falls;
      s.low1 = s.low2 = !strobe_n;
    };
    arrive(rd_, in.rd_falls, in.cpu_rd_n);
    arrive(wr_, in.wr_falls, in.cpu_wr_n);
    return;
  }
  for (; count > 0; --count) {
    cpu_edge(false);
    cpu_pins();
  }
}

void Dpram::cpu_edge(bool blocked) {
  if (proven_ && still()) poke(cell_, wdata_);
  const bool asked = request(), write = wr_.low(), grant = asked && !blocked;
  const bool over_since = released();
  proven_ = sampled_ && still();
  sampled_ = grant && write;
  rd_.acknowledged = rd_.done;
  const auto follow = [this](Strobe& s, bool granted) {
    if (granted || s.vain(sel_)) s.done = s.falls2;
  };
  follow(rd_, grant && !write);
  follow(wr_, grant);
  cpu_busy_ = asked && blocked;
  if (grant) {
    own_ = true;
    own_wr_ = write;
    cell_ = pins_;
    wdata_ = in.cpu_wdata;
    if (!write) {
      cpu_rdata_ = peek(cell_);
      drive_ = !in.cpu_rd_n;
      drive_rd_ = rd_.falls2;
    }
  } else if (over_since) {
    own_ = false;
  }
}

void Dpram::cpu_pins() {
  const auto sample = [](Strobe& s, std::uint8_t falls, bool strobe_n) {
    s.falls3 = s.falls2;
    s.falls2 = s.falls1;
    s.falls1 = falls;
    s.low2 = s.low1;
    s.low1 = !strobe_n;
  };
  sample(rd_, in.rd_falls, in.cpu_rd_n);
  sample(wr_, in.wr_falls, in.cpu_wr_n);
  sel_ = in.cpu_sel;
  pins_ = pin_cell();
}

void Dpram::host_edge(bool blocked) {
  if (in.mem_wr && host_own_) poke(in.mem_addr, in.mem_wdata, in.mem_be);
  const bool grant = in.mem_sel && !host_own_ && !blocked;
  if (grant && in.mem_rd) mem_rdata_ = peek(in.mem_addr);
  mem_busy_ = in.mem_sel && !host_own_ && blocked;
  host_own_ = in.mem_sel && (host_own_ || grant);
}

// A write that was granted but not made yet is lost; the memory keeps its content.
void Dpram::reset(Tick t) {
  rd_ = wr_ = Strobe{};
  drive_ = sel_ = cpu_busy_ = own_ = sampled_ = proven_ = host_own_ = mem_busy_ = false;
  cpu_rdata_ = mem_rdata_ = 0;
  now_ = t;
}

}  // namespace brick
