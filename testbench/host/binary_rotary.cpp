#include "testbench/host/binary_rotary.h"

#include "rtl/regs/dpram_map.h"

namespace brick {

namespace {

constexpr std::uint32_t kItems = 2;     // of a command
constexpr std::uint32_t kReserved = 4;  // items: the end-of-buffer command, and what tells full from empty
constexpr std::uint32_t kLeastSize = 6;
constexpr BinaryCommand kEndOfBuffer = {0x000800, 0x00FFFF};

std::uint32_t extended(std::uint32_t word) { return (word & 0x800000) != 0 ? word | 0xFF000000 : word; }

}  // namespace

std::uint32_t BinaryRotary::header() const { return DPRAM_ROTARY_HEADERS + (cs_ - 1) * DPRAM_ROTARY_STRIDE; }

BinaryResult BinaryRotary::define(std::uint32_t start, std::uint32_t size) {
  if (size < kLeastSize || size % kItems != 0) return BinaryResult::kError;
  if (DPRAM_OPEN + DPRAM_ITEM_BYTES * (std::uint64_t{start} + size) > regs::kDpramWindowSize)
    return BinaryResult::kAllocation;
  start_ = start;
  size_ = size;
  disable();
  write(DPRAM_ROTARY_SIZE, static_cast<std::uint16_t>(size));
  write(DPRAM_ROTARY_START, static_cast<std::uint16_t>(start));
  return recover();
}

BinaryResult BinaryRotary::recover() {
  if (size_ == 0) return BinaryResult::kError;
  index_ = pmac_index_ = 0;
  write(DPRAM_ROTARY_HOST_INDEX, 0);
  write(DPRAM_ROTARY_PMAC_INDEX, 0);
  write_command(0, kEndOfBuffer);
  write(DPRAM_ROTARY_STATUS, 0);
  return BinaryResult::kOk;
}

void BinaryRotary::enable() { write(DPRAM_ROTARY_ENABLE, static_cast<std::uint16_t>(cs_)); }
void BinaryRotary::disable() { write(DPRAM_ROTARY_ENABLE, 0); }
std::uint16_t BinaryRotary::status() { return read(DPRAM_ROTARY_STATUS); }
bool BinaryRotary::empty() { return read(DPRAM_ROTARY_PMAC_INDEX) == index_; }

void BinaryRotary::write_command(std::uint32_t index, const BinaryCommand& command) {
  std::uint32_t offset = DPRAM_OPEN + DPRAM_ITEM_BYTES * (start_ + index);
  for (const std::uint32_t word : {extended(command.first), extended(command.second)}) {
    bus_.dpram_write(offset, static_cast<std::uint16_t>(word));
    bus_.dpram_write(offset + DPRAM_WORD_BYTES, static_cast<std::uint16_t>(word >> 16));
    offset += DPRAM_ITEM_BYTES;
  }
}

// The controller's index is looked at only when the last one leaves no room.
bool BinaryRotary::has_room(std::uint32_t items) {
  const auto fits = [&] { return (index_ + size_ - pmac_index_) % size_ + items + kReserved <= size_; };
  if (fits()) return true;
  pmac_index_ = read(DPRAM_ROTARY_PMAC_INDEX) % size_;
  return fits();
}

BinaryResult BinaryRotary::stage(const std::vector<BinaryCommand>& line) {
  const auto items = static_cast<std::uint32_t>(kItems * line.size());
  if (size_ == 0 || items + kReserved > size_) return BinaryResult::kError;
  if (!has_room(items)) return (status() & DPRAM_ROTARY_ERROR) != 0 ? BinaryResult::kError : BinaryResult::kBusy;
  for (const BinaryCommand& command : line) {
    write_command(index_, command);
    index_ = (index_ + kItems) % size_;
  }
  return BinaryResult::kOk;
}

void BinaryRotary::commit() {
  write_command(index_, kEndOfBuffer);
  write(DPRAM_ROTARY_HOST_INDEX, static_cast<std::uint16_t>(index_));
}

BinaryResult BinaryRotary::put(const std::vector<BinaryCommand>& line) {
  const BinaryResult result = stage(line);
  if (result == BinaryResult::kOk && !line.empty()) commit();
  return result;
}

BinaryResult BinaryRotary::put(std::string_view line) {
  const BinaryLine made = binary_line(line);
  return made.result == BinaryResult::kOk ? put(made.commands) : made.result;
}

BinaryResult BinaryRotary::feed(std::istream& lines) {
  bool any = false;
  BinaryResult result = BinaryResult::kOk;
  while (result == BinaryResult::kOk) {
    if (held_.empty() && !std::getline(lines, held_)) {
      result = BinaryResult::kEndOfFile;
      break;
    }
    const BinaryLine made = binary_line(held_);
    result = made.result == BinaryResult::kOk ? stage(made.commands) : made.result;
    if (result != BinaryResult::kBusy) held_.clear();
    any |= result == BinaryResult::kOk && !made.commands.empty();
  }
  if (any) commit();
  return result;
}

}  // namespace brick
