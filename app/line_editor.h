// A line that somebody types at a terminal, with editing and history (libedit). While no key is pressed, time belongs
// to the caller. Throws what the caller's functions throw.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace brick {

class LineEditor {
 public:
  explicit LineEditor(const std::string& prompt);
  ~LineEditor();
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  std::optional<std::string> read();  // nothing at ^], or when the terminal is gone
  void make_room();                   // whoever prints: before it, where a line is being typed

  static bool may_be_history(const std::string& file);  // it is one, or there is none yet
  void load_history(const std::string& file);           // if there is one
  bool save_history(const std::string& file) const;     // false: it cannot be written

  // Is called again and again until a key is pressed, which it looks for in the time between.
  std::function<std::chrono::milliseconds()> while_waiting;
  std::function<void(char)> on_control;  // a control key that does not edit: all but Tab, Backspace, Return, Escape

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
