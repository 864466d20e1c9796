// Memory of the machine, see memory.h.
#include "systemc/machine/memory.h"

#include <cstring>
#include <random>

namespace brick {

namespace {
constexpr std::uint8_t kErased = 0xFF;
constexpr std::uint32_t kWordMask = 0xFFFFFF;
}  // namespace

MachineMemory::MachineMemory(Cpu& cpu, std::string flash_file, bool ssi_page)
    : cpu_(cpu), flash_file_(std::move(flash_file)) {
  constexpr std::uint32_t kPage = 8 * regs::kSsiPageBase, kPageEnd = kPage + 8 * regs::kSsiPageSize;
  if (ssi_page)
    main_ = {{kMain, kPage}, {kMain + kPageEnd, kMainBytes - kPageEnd}};
  else
    main_ = {{kMain, kMainBytes}};
  cpu_.map(kCode, kCodeBytes, {true, false, 0});
  cpu_.map(kRam, kRamBytes, {});
  std::memset(cpu_.map(kFlash, kFlashBytes, {}), kErased, kFlashBytes);
  cpu_.map(kStraps, kStrapsBytes, {true, false, 0});
  for (const Part& part : main_) cpu_.map(part.base, part.bytes, {false, true, 0});
  flash_file_.load(cpu_.memory(kFlash, kFlashBytes), kFlashBytes);
  for (const std::uint32_t state : kSlotStates) cpu_.watch_store(state);
  cpu_.on_store_watch = [this](std::uint32_t, std::uint32_t value) {
    if (value == kOutdated && on_saved) on_saved();
    return false;
  };
}

void MachineMemory::set_main_wait(Cycle wait) {
  for (const Part& part : main_) cpu_.set_wait(part.base, wait);
}

void MachineMemory::save_flash() { flash_file_.save(cpu_.memory(kFlash, kFlashBytes), kFlashBytes); }

void MachineMemory::set_strap(Strap strap, std::uint32_t value) {
  std::memcpy(cpu_.memory(kStraps, kStrapsBytes) + 4 * static_cast<std::uint32_t>(strap), &value, sizeof value);
}

void MachineMemory::randomize(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto fill = [&](std::uint32_t base, std::uint32_t bytes, std::uint32_t mask) {
    std::uint8_t* p = cpu_.memory(base, bytes);
    for (std::uint32_t i = 0; i < bytes; i += 8) {
      const std::uint64_t word = random() & (static_cast<std::uint64_t>(mask) << 32 | mask);
      std::memcpy(p + i, &word, sizeof word);
    }
  };
  fill(kRam, kRamBytes, ~0u);
  for (const Part& part : main_) fill(part.base, part.bytes, kWordMask);
  cpu_.invalidate_code();
}

}  // namespace brick
