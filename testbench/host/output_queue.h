// What the controller has said to one client and nobody has fetched yet, and where a fetch stops (ethernet:4).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace brick {

class OutputQueue {
 public:
  static constexpr std::size_t kLimit = 1 << 20;  // bytes; what comes beyond it is lost

  void add(std::string_view text);
  void clear();
  std::size_t size() const { return bytes_.size() - at_; }
  bool empty() const { return size() == 0; }

  // Up to and including ACK or LF, or the CR behind a BEL or STX, at most `most`; none when there is no such end yet.
  std::optional<std::string> take_answer(std::size_t most);
  std::optional<std::string> take_line(std::size_t most);  // up to and including the first CR, ACK or LF
  std::string take(std::size_t most);                      // as much as there is

 private:
  std::string bytes_;
  std::size_t at_ = 0;         // what is before it has been taken
  std::size_t looked_ = 0;     // no end before this
  bool until_return_ = false;  // BEL or STX was seen before it
};

}  // namespace brick
