// Slow paths of memory: region look-up, device accesses, watched words, and the upkeep of predecoded pages. The
// execution loop handles the frequent cases itself, through the tables that are filled here.
#include <algorithm>
#include <cstring>

#include "systemc/cpu/cpu_state.h"
#include "systemc/cpu/cycle_costs.h"

namespace brick {

using namespace cpu;

Region* Cpu::State::find(std::uint32_t address, std::uint32_t bytes) {
  for (Region& r : regions) {
    if (r.holds(address, bytes)) return &r;
  }
  return nullptr;
}

void Cpu::State::forget_translations() {
  load_tlb.fill(LoadEntry{});
  store_tlb.fill(StoreEntry{});
  code_tlb.fill(nullptr);
}

Access Cpu::State::load(std::uint32_t address, unsigned bytes) {
  if (address % bytes != 0) {
    fault = kLoadMisaligned;
    return Access::kFault;
  }
  if (Region* r = find(address, bytes)) {
    value = 0;
    std::memcpy(&value, r->data.get() + (address - r->base), bytes);
    cycle += r->options.wait;
    const std::uint32_t page = address & kPageMask;
    if (r->holds(page, kPageBytes)) {
      load_tlb[tlb_index(address)] = {page, r->data.get() + (page - r->base), r->options.wait};
    }
    return Access::kDone;
  }
  if (devices == nullptr) {
    fault = kLoadFault;
    return Access::kFault;
  }
  const DeviceBus::Result result = devices->access(address, bytes, false, 0, cycle);
  access_waits = result.retry;
  if (result.retry) return Access::kRetry;
  cycle = std::max(cycle, result.done);
  device_accessed = result.fault;
  value = bytes == 4 ? result.data : result.data & ((1u << 8 * bytes) - 1);
  fault = kLoadFault;
  return result.fault ? Access::kFault : Access::kDevice;
}

Access Cpu::State::store(std::uint32_t address, unsigned bytes, std::uint32_t data) {
  if (address % bytes != 0) {
    fault = kStoreMisaligned;
    return Access::kFault;
  }
  Region* r = find(address, bytes);
  if (r != nullptr && r->options.read_only) {
    fault = kStoreFault;
    return Access::kFault;
  }
  const std::uint32_t word = address & ~3u;
  const bool is_watched = std::find(watched.begin(), watched.end(), word) != watched.end();
  if (r != nullptr) {
    std::uint8_t* const place = r->data.get() + (address - r->base);
    std::memcpy(place, &data, bytes);
    if (r->options.mask24) r->data.get()[word + 3 - r->base] = 0;
    cycle += r->options.wait;
    code_changed(address, bytes);
    const std::uint32_t page = address & kPageMask;
    const bool page_watched =
        std::any_of(watched.begin(), watched.end(), [&](std::uint32_t w) { return (w & kPageMask) == page; });
    if (!page_watched && r->holds(page, kPageBytes)) {
      StoreEntry& e = store_tlb[tlb_index(address)];
      e.word_tag = page;
      e.part_tag = r->options.mask24 ? kNoTag : page;
      e.mask = r->options.mask24 ? 0xFFFFFFu : ~0u;
      e.has_code = code_pages.count(page) != 0;
      e.host = r->data.get() + (page - r->base);
      e.wait = r->options.wait;
    }
  } else {
    fault = kStoreFault;
    if (devices == nullptr) return Access::kFault;
    const std::uint32_t used = bytes == 4 ? data : data & ((1u << 8 * bytes) - 1);
    const DeviceBus::Result result = devices->access(address, bytes, true, used, cycle);
    access_waits = result.retry;
    if (result.retry) return Access::kRetry;
    cycle = std::max(cycle, result.done);
    device_accessed = result.fault;
    if (result.fault) return Access::kFault;
  }
  if (is_watched && cpu.on_store_watch && cpu.on_store_watch(address, data)) return Access::kHalt;
  return r != nullptr ? Access::kDone : Access::kDevice;
}

CodePage* Cpu::State::code_page(std::uint32_t at) {
  const std::uint32_t page = at & kPageMask;
  CodePage*& cached = code_tlb[tlb_index(at)];
  if (cached != nullptr && cached->base == page) return cached;
  if (find(at, 2) == nullptr) return nullptr;
  auto& owned = code_pages[page];
  if (owned == nullptr) {
    owned = std::make_unique<CodePage>(page);
    store_tlb.fill(StoreEntry{});  // from now on stores to this page must invalidate
  }
  cached = owned.get();
  return cached;
}

bool Cpu::State::fetch(std::uint32_t at, std::uint32_t& word, std::uint32_t& fault_address) {
  std::uint16_t half[2] = {0, 0};
  for (unsigned i = 0; i < 2; ++i) {
    const std::uint32_t address = at + 2 * i;
    Region* r = find(address, 2);
    if (r == nullptr) {
      fault_address = address;
      return false;
    }
    std::memcpy(&half[i], r->data.get() + (address - r->base), 2);
    if (i == 0 && is_compressed(half[0])) break;
    if (i == 1 && (address & ~kPageMask) == 0) code_page(address);  // its second half must be guarded too
  }
  word = half[0] | static_cast<std::uint32_t>(half[1]) << 16;
  return true;
}

void Cpu::State::code_changed(std::uint32_t address, unsigned bytes) {
  // The instruction that begins one halfword earlier may end here.
  const std::uint32_t last = (address + bytes - 1) & ~1u;
  for (std::uint32_t at = (address & ~1u) - 2;; at += 2) {
    const auto found = code_pages.find(at & kPageMask);
    if (found != code_pages.end()) found->second->entry[(at & ~kPageMask) / 2].op = Op::kDecode;
    if (at == last) break;
  }
}

void Cpu::State::add_decoded(std::set<std::uint32_t>& addresses) const {
  for (const auto& [base, page] : code_pages)
    for (std::uint32_t i = 0; i < kPageEntries; ++i)
      if (page->entry[i].op != Op::kDecode) addresses.insert(base + 2 * i);
}

void Cpu::State::invalidate_code() {
  add_decoded(executed);
  for (auto& [base, page] : code_pages) page->clear();
}

}  // namespace brick
