// Memory of the machine, see memory.h.
#include "systemc/machine/memory.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

namespace brick {

namespace {
constexpr std::uint8_t kErased = 0xFF;
constexpr std::uint32_t kWordMask = 0xFFFFFF;

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw std::runtime_error(fmt::format("flash file {}: {}", file, what));
}
}  // namespace

MachineMemory::MachineMemory(Cpu& cpu, std::string flash_file) : cpu_(cpu), flash_file_(std::move(flash_file)) {
  cpu_.map(kCode, kCodeBytes, {true, false, 0});
  cpu_.map(kRam, kRamBytes, {});
  std::memset(cpu_.map(kFlash, kFlashBytes, {}), kErased, kFlashBytes);
  cpu_.map(kStraps, kStrapsBytes, {true, false, 0});
  cpu_.map(kMain, kMainBytes, {false, true, 0});
  if (!flash_file_.empty()) load_flash();
}

void MachineMemory::load_flash() {
  std::error_code error;
  const bool exists = std::filesystem::exists(flash_file_, error);
  if (error) fail(flash_file_, "cannot be read: " + error.message());
  if (!exists) return save_flash();  // tells now, not at the end, that it cannot be written
  if (!std::filesystem::is_regular_file(flash_file_)) fail(flash_file_, "is not a file");
  const auto size = std::filesystem::file_size(flash_file_, error);
  if (error) fail(flash_file_, "cannot be read: " + error.message());
  if (size != kFlashBytes) fail(flash_file_, fmt::format("has {} bytes; expected {}", size, kFlashBytes));
  std::ifstream in(flash_file_, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(cpu_.memory(kFlash, kFlashBytes)), kFlashBytes))
    fail(flash_file_, std::string("cannot be read: ") + std::strerror(errno));
  if (!std::ofstream(flash_file_, std::ios::binary | std::ios::app))
    fail(flash_file_, std::string("cannot be written: ") + std::strerror(errno));
}

void MachineMemory::save_flash() const {
  if (flash_file_.empty()) return;
  std::ofstream out(flash_file_, std::ios::binary | std::ios::trunc);
  if (!out || !out.write(reinterpret_cast<const char*>(cpu_.memory(kFlash, kFlashBytes)), kFlashBytes) || !out.flush())
    fail(flash_file_, std::string("cannot be written: ") + std::strerror(errno));
}

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
  fill(kMain, kMainBytes, kWordMask);
  cpu_.invalidate_code();
}

}  // namespace brick
