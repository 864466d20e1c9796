#include "app/page/image_calls.h"

#include <cstring>
#include <utility>

#include "systemc/machine/memory.h"

namespace brick {

namespace {

constexpr std::uint32_t kOwn = 0x4000'0000, kOwnBytes = 0x4000;  // code, words, and the stack that ends it
constexpr std::uint32_t kReturnTo = kOwn, kPutRegister = kOwn + 0x800;
constexpr Cycle kSlice = 1000, kLongestCall = 1'000'000;  // CPU clocks; a function that looks takes a few thousand
constexpr unsigned kRa = 1, kSp = 2, kGp = 3, kA0 = 10;

constexpr std::uint32_t kWfi = 0x10500073;
constexpr std::uint32_t kPutCode[] = {
    0x400012b7,  // lui t0, 0x40001
    0x80a2a023,  // sw a0, -0x800(t0)
    0x00008067,  // ret
};

}  // namespace

ImageCalls::ImageCalls(Machine& machine, const std::string& firmware) : machine_(machine), image_(firmware) {
  Cpu& real = machine.cpu();
  for (const Cpu::Mapping& region : real.mappings())
    if (region.base != MachineMemory::kRam && region.base != MachineMemory::kFlash)
      cpu_.share(region.base, region.bytes, real.memory(region.base, region.bytes));
  const std::uint32_t end = image_.symbol("__bss_end").value_or(MachineMemory::kRam + MachineMemory::kRamBytes);
  ram_bytes_ = (end - MachineMemory::kRam + 3) / 4 * 4;
  ram_ = cpu_.map(MachineMemory::kRam, ram_bytes_, {});
  std::uint8_t* own = cpu_.map(kOwn, kOwnBytes, {});
  std::memcpy(own, &kWfi, sizeof kWfi);
  std::memcpy(own + (kPut - kOwn), kPutCode, sizeof kPutCode);
  cpu_.watch_store(kPutRegister);
  cpu_.on_store_watch = [this](std::uint32_t, std::uint32_t value) {
    text_.push_back(static_cast<char>(value));
    return false;
  };
  cpu_.on_trap = [this](std::uint32_t, std::uint32_t, Cycle) { trapped_ = true; };
  refresh();
}

void ImageCalls::refresh() { std::memcpy(ram_, machine_.cpu().memory(MachineMemory::kRam, ram_bytes_), ram_bytes_); }

std::optional<std::uint64_t> ImageCalls::call(const std::string& function,
                                              std::initializer_list<std::uint32_t> arguments) {
  const auto address = image_.symbol(function);
  if (!address) return std::nullopt;
  cpu_.reset(*address);
  cpu_.set_reg(kRa, kReturnTo);
  cpu_.set_reg(kSp, kOwn + kOwnBytes);
  cpu_.set_reg(kGp, machine_.cpu().reg(kGp));  // the same in all of the image
  unsigned at = kA0;
  for (const std::uint32_t argument : arguments) cpu_.set_reg(at++, argument);
  trapped_ = false;
  const Cycle limit = cpu_.cycle() + kLongestCall;
  while (!trapped_ && cpu_.cycle() < limit)
    if (cpu_.run(cpu_.cycle() + kSlice) == Cpu::Stop::kSleep)
      return cpu_.reg(kA0) | std::uint64_t{cpu_.reg(kA0 + 1)} << 32;
  return std::nullopt;
}

std::uint32_t ImageCalls::word(unsigned index) {
  std::uint32_t value = 0;
  std::memcpy(&value, cpu_.memory(kWords + 4 * index, 4), sizeof value);
  return value;
}

void ImageCalls::set_word(unsigned index, std::uint32_t value) {
  std::memcpy(cpu_.memory(kWords + 4 * index, 4), &value, sizeof value);
}

std::string ImageCalls::take_text() { return std::exchange(text_, {}); }

}  // namespace brick
