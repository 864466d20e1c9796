// Plays a host script against a running controller and prints the replies.
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/refused_lines.h"
#include "app/script.h"
#include "testbench/host/host_link.h"

namespace brick {

// The script asked for something that did not come true, or the controller does not answer: `brick exec` ends with
// status 1.
class ScriptFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ScriptPlayer {
 public:
  // `raw` prints every byte received, control bytes as <06>.
  ScriptPlayer(HostLink& link, std::ostream& out, bool raw) : link_(link), out_(out), raw_(raw) {}

  void check(const std::vector<ScriptLine>& script) const;  // names and values of signals; throws UsageError
  void play(const std::vector<ScriptLine>& script);
  void print_unsolicited();  // what programs have sent

  // Is told of each line that the controller refused and no @expect behind it expected: place, line, error, meaning.
  std::function<void(const std::string&)> on_refused;
  std::function<void()> before_output;  // is called before each line that is printed
  std::size_t played() const { return played_; }
  const RefusedLines& refused() const { return refused_; }

  struct Exchange {
    std::string place, line;
    std::vector<std::string> reply;
    bool error;
  };
  const std::vector<Exchange>& exchanges() const { return exchanges_; }

 private:
  void play_line(const ScriptLine& line);
  void refuse(const ScriptLine& line);
  void command(const ScriptLine& line);
  void answer(const ScriptLine& line, const std::vector<std::string>& lines, bool error = false);
  void keep(const ScriptLine& line, const std::vector<std::string>& lines, bool error);
  void print(const std::vector<std::string>& lines);
  void restart(const ScriptLine& line);
  void reconnect(const ScriptLine& line);  // the controller has started anew
  void turn_encoder(const ScriptLine& line);
  [[noreturn]] void fail(const ScriptLine& line, const std::string& text) const;

  HostLink& link_;
  std::ostream& out_;
  bool raw_;
  std::vector<std::string> last_;  // what @expect compares with, as it is printed
  bool last_refused_ = false;
  std::size_t played_ = 0;
  RefusedLines refused_;
  std::vector<Exchange> exchanges_;
};

}  // namespace brick
