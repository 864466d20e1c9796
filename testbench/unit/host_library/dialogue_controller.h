// A controller behind the port of the fake machine that knows the dialogue alone: I3, I4, I6 as assigned, answers
// framed as the data sheet says (firmware:6.2, firmware:6.3, firmware:6.5), ^B, ^G, and a few commands.
#pragma once

#include <functional>
#include <string>

#include "testbench/unit/firmware_platform/framing.h"
#include "testbench/unit/host_library/fake_machine.h"

namespace brick {

class DialogueController {
 public:
  static constexpr const char* kMotorWords =
      "0123456789AB 850000000000 050000000000 050000000000 050000000000 050000000000 050000000000 050000000000";

  explicit DialogueController(FakeMachine& machine) {
    machine.controller = [this](const std::string& line) { return answer(line); };
    machine.control = [this](char c) {
      return c == 0x02 ? framed(now(), "", {kMotorWords}) : c == 0x07 ? framed(now(), "", {"0123456789AB"}) : "";
    };
  }

  unsigned i3 = 1, i4 = 0, i6 = 1;
  bool acknowledges_by_the_old = false;  // a line that changes I3, else by the new one
  int restarts = 0;
  std::function<void()> before_line;  // what a program does meanwhile

  // A line that a program sends (firmware:6.2: without acknowledge).
  std::string data(const std::string& text) const {
    const std::string line = (i3 % 2 == 1 ? "\n" : "") + text + "\r";
    return i4 % 2 == 1 ? line + checksum(line) : line;
  }

 private:
  Framing now() const { return {i3, i4}; }

  // Commands with spaces between them, I3=n, I4=n, I6=n, I3, P1 to P4 (25, 50, 3, 22221), P6 in the form of ^B's
  // answer, ??, $$$; UUU is an error.
  std::string answer(const std::string& line) {
    if (before_line) before_line();
    const Framing before = now();
    std::string bytes;
    std::istringstream in(line);
    for (std::string word; in >> word;) {
      for (const auto& [name, text] :
           {std::pair("P1", "25"), std::pair("P2", "50"), std::pair("P3", "3"), std::pair("P4", "22221"),
            std::pair("P6", kMotorWords), std::pair("?", "123456789012"), std::pair("??", "A80020020000000000")})
        if (word == name) bytes += data(text);
      if (word == "I3") bytes += data(std::to_string(i3));
      if (word.size() == 4 && word[0] == 'I' && word[2] == '=')
        (word[1] == '3' ? i3 : word[1] == '4' ? i4 : i6) = static_cast<unsigned>(word[3] - '0');
      if (word == "I6=1I3=2I4=0") i6 = 1, i3 = 2, i4 = 0;  // what the host link begins with
      if (word.rfind("$$$", 0) == 0) {
        ++restarts;
        i3 = i6 = 1;
        i4 = 0;
        return bytes;
      }
      if (word == "UUU") return bytes + error();
    }
    Framing style = acknowledges_by_the_old ? before : now();
    style.i4 = i4;
    return bytes + framed(style, line, {});
  }

  std::string error() const {
    if (i6 % 2 == 0) return "\x07";
    return std::string("\x07") + (i6 == 3 ? "\r" : "") + (i3 % 2 == 1 ? "\n" : "") + "ERR003\r";
  }
};

}  // namespace brick
