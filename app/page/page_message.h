// What the page asks for over its websocket: JSON, an object a message (docs/page.md).
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace brick {

// A line for the controller, through the port.
struct PageCommand {
  std::int64_t id = 0;  // the answer has it too
  std::string line;
};

// What the watch list reads by the back door, in place of what it has read so far.
struct PageWatch {
  std::vector<std::string> items;
};

using PageMessage = std::variant<PageCommand, PageWatch>;

class PageMistake : public std::runtime_error {
 public:
  explicit PageMistake(const std::string& what, std::optional<std::int64_t> of = std::nullopt)
      : std::runtime_error(what), id(of) {}
  std::optional<std::int64_t> id;  // of the command
};

constexpr std::size_t kMostPageMessage = 4096;  // bytes

PageMessage parse_page_message(const std::string& text);  // throws PageMistake

}  // namespace brick
