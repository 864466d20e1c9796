// What an 8259A does, said a second time and in other terms than the module and its model: eight levels in a list,
// highest priority first; reads, writes and acknowledges one after the other, the lines at rest in between. From
// Intel's description of the part alone (docs/pic_8259.md has the choices where that is silent).
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace brick {

class Reference8259 {
 public:
  void line(unsigned n, bool high) {
    Level& l = levels_[n];
    if (high && !l.high) l.edge = true;
    if (!high) l.edge = false;  // a request lives as long as its line is high
    l.high = high;
  }

  bool interrupts() const { return winner().has_value(); }
  bool polls() const { return poll_; }  // the next read is one

  // The acknowledge cycle.
  std::uint8_t vector() { return static_cast<std::uint8_t>(base_ | take(winner())); }

  std::uint8_t read(bool a0) {
    if (poll_) {
      poll_ = false;
      const std::optional<unsigned> level = winner();
      return static_cast<std::uint8_t>((level ? 0x80u : 0u) | take(level));
    }
    return bits([&](const Level& l) { return a0 ? l.masked : read_in_service_ ? l.in_service : requests(l); });
  }

  void write(bool a0, std::uint8_t byte) {
    if (a0)
      to_come_.empty() ? mask(byte) : initialize(byte);
    else if ((byte >> 4 & 1) != 0)
      begin(byte);
    else if ((byte >> 3 & 1) != 0)
      status_and_special(byte);
    else
      end(byte);
  }

 private:
  struct Level {
    bool high = false, edge = false, in_service = false, masked = true;
  };
  enum class Word { kIcw2, kIcw3, kIcw4 };

  bool requests(const Level& l) const { return l.high && (by_level_ || l.edge); }
  bool holds_off(const Level& l) const { return l.in_service && !(special_ && l.masked); }

  // Down the list until a level in service closes it.
  std::optional<unsigned> winner() const {
    if (!to_come_.empty()) return std::nullopt;
    for (const unsigned n : order_) {
      if (holds_off(levels_[n])) return std::nullopt;
      if (requests(levels_[n]) && !levels_[n].masked) return n;
    }
    return std::nullopt;
  }

  unsigned take(std::optional<unsigned> level) {
    if (!level) return 7;
    levels_[*level].edge = false;
    if (!automatic_end_)
      levels_[*level].in_service = true;
    else if (rotate_at_automatic_end_)
      make_lowest(*level);
    return *level;
  }

  void make_lowest(unsigned level) {
    while (order_.back() != level) std::rotate(order_.begin(), order_.begin() + 1, order_.end());
  }

  void begin(std::uint8_t byte) {  // ICW1
    for (Level& l : levels_) l.edge = l.in_service = l.masked = false;
    order_ = {0, 1, 2, 3, 4, 5, 6, 7};
    special_ = read_in_service_ = poll_ = automatic_end_ = rotate_at_automatic_end_ = false;
    by_level_ = (byte & 8) != 0;
    to_come_ = {Word::kIcw2};
    if ((byte & 2) == 0) to_come_.push_back(Word::kIcw3);
    if ((byte & 1) != 0) to_come_.push_back(Word::kIcw4);
  }
  void initialize(std::uint8_t byte) {
    const Word word = to_come_.front();
    to_come_.pop_front();
    if (word == Word::kIcw2) base_ = byte / 8 * 8;
    if (word == Word::kIcw4) automatic_end_ = (byte & 2) != 0;
  }
  void mask(std::uint8_t byte) {
    for (unsigned n = 0; n < 8; ++n) levels_[n].masked = (byte >> n & 1) != 0;
  }
  void status_and_special(std::uint8_t byte) {  // OCW3
    switch (byte >> 5 & 3) {
      case 2:
        special_ = false;
        break;
      case 3:
        special_ = true;
        break;
    }
    switch (byte & 3) {
      case 2:
        read_in_service_ = false;
        break;
      case 3:
        read_in_service_ = true;
        break;
    }
    poll_ = (byte & 4) != 0;
  }
  void end(std::uint8_t byte) {  // OCW2
    const unsigned named = byte & 7;
    switch (byte >> 5) {
      case 0b000:
        rotate_at_automatic_end_ = false;
        break;
      case 0b100:
        rotate_at_automatic_end_ = true;
        break;
      case 0b110:
        make_lowest(named);
        break;
      case 0b011:
        levels_[named].in_service = false;
        break;
      case 0b111:
        levels_[named].in_service = false;
        make_lowest(named);
        break;
      case 0b001:
      case 0b101: {
        const auto highest =
            std::find_if(order_.begin(), order_.end(), [&](unsigned n) { return holds_off(levels_[n]); });
        if (highest == order_.end()) break;
        const unsigned ended = *highest;
        levels_[ended].in_service = false;
        if (byte >> 7 != 0) make_lowest(ended);
        break;
      }
    }
  }

  template <class F>
  std::uint8_t bits(F of) const {
    unsigned byte = 0;
    for (unsigned n = 0; n < 8; ++n) byte |= (of(levels_[n]) ? 1u : 0u) << n;
    return static_cast<std::uint8_t>(byte);
  }

  std::vector<Level> levels_ = std::vector<Level>(8);
  std::vector<unsigned> order_{0, 1, 2, 3, 4, 5, 6, 7};
  std::deque<Word> to_come_;
  std::uint8_t base_ = 0;
  bool by_level_ = false, automatic_end_ = false, rotate_at_automatic_end_ = false;
  bool special_ = false, read_in_service_ = false, poll_ = false;
};

}  // namespace brick
