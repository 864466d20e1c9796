// The drawings and tables of docs/components.md are made from the pin tables that make the ports. They are held to them
// here; BRICK_WRITE_PAGES=1 writes them anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <brick/board.h>
#include <brick/clock_select.h>
#include <brick/dpram.h>
#include <brick/host_port.h>
#include <brick/host_signals.h>
#include <brick/interrupt_controller.h>
#include <brick/macro_ic.h>
#include <brick/servo_ic.h>
#include <brick/watchdog.h>

namespace brick::component {
namespace {

// One channel of one IC stands for all, one IC of the clock selection too; "" for the others.
std::string shown_name(std::string name) {
  const auto replace = [&name](const std::string& one, const std::string& all) {
    if (const auto at = name.find(one); at != std::string::npos) name.replace(at, one.size(), all);
  };
  if (name.rfind("servo_ic1_", 0) == 0) return "";
  for (const char* other : {"ch2_", "ch3_", "ch4_"})
    if (name.find(other) != std::string::npos) return "";
  for (const std::string pins : {"phase_i", "servo_i", "phase_oe_i", "servo_oe_i"}) {
    if (name.size() == pins.size() || name.compare(0, pins.size(), pins) != 0) continue;
    if (name != pins + "0") return "";
    name = pins + "N";
  }
  replace("ch1_", "chN_");
  replace("servo_ic0_", "servo_icM_");
  return name;
}

std::string pad(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width > text.size() ? width - text.size() : 0, ' ');
  return left ? blanks + text : text + blanks;
}

std::string repeat(const char* text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

// Inputs on the left, outputs on the right, the socket on top.
std::string drawing(const std::string& title, const std::vector<PinInfo>& table, const std::string& socket) {
  std::vector<std::string> in, out;
  for (const PinInfo& info : table) {
    std::string name = shown_name(info.name);
    if (name.empty() || info.direction == PinDirection::kInner) continue;
    if (info.width > 1) name += "[" + std::to_string(info.width) + "]";
    (info.direction == PinDirection::kIn ? in : out).push_back(name);
  }
  constexpr std::size_t kInside = 26, kName = 24;
  std::ostringstream text;
  const std::size_t before = (kInside - title.size()) / 2;
  text << "```\n";
  if (!socket.empty()) text << std::string(kName + 5 + kInside / 2, ' ') << "║ " << socket << "\n";
  text << std::string(kName + 4, ' ') << "┌" << repeat("─", before - 1) << " " << title << " "
       << repeat("─", kInside - before - title.size() - 1) << "┐\n";
  for (std::size_t i = 0; i < std::max(in.size(), out.size()); ++i)
    text << (i < in.size() ? pad(in[i], kName, true) + " ──►" : std::string(kName + 4, ' ')) << "│"
         << std::string(kInside, ' ') << "│" << (i < out.size() ? "──► " + out[i] : "") << "\n";
  text << std::string(kName + 4, ' ') << "└" << repeat("─", kInside) << "┘\n```\n\n";
  text << "| pin | | what | data sheet |\n|---|---|---|---|\n";
  for (const PinInfo& info : table) {
    const std::string name = shown_name(info.name);
    if (name.empty() || info.direction == PinDirection::kInner) continue;
    text << "| `" << name << "` | " << (info.direction == PinDirection::kIn ? "in" : "out");
    if (info.width > 1) text << ", " << info.width << " bits";
    if (info.idle != 0) {
      if (info.width > 1)
        text << ", idle $" << std::hex << std::uppercase << info.idle << std::dec;
      else
        text << ", idle 1";
    }
    text << " | " << info.meaning << " | " << info.section << " |\n";
  }
  return text.str();
}

std::string read(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ComponentPages, DrawingsAreThoseOfThePinTables) {
  std::string page = read(BRICK_COMPONENTS_PAGE);
  const std::string before = page;
  const auto place = [&page](const std::string& name, const std::string& text) {
    const std::string begin = "<!-- pins of " + name + " -->\n", end = "<!-- end -->";
    const auto from = page.find(begin);
    ASSERT_NE(from, std::string::npos) << begin;
    page.replace(from + begin.size(), page.find(end, from) - from - begin.size(), text);
  };
  place("servo_ic", drawing("ServoIc", ServoIc::pin_table(), "registers: 32 X and 32 Y words"));
  place("interrupt_controller", drawing("InterruptController", InterruptController::pin_table(), "registers: 4 bytes"));
  place("host_signals", drawing("HostSignals", HostSignals::pin_table(), "registers: 2 words"));
  place("watchdog", drawing("Watchdog", Watchdog::pin_table(), "registers: 1 word"));
  place("macro_ic", drawing("MacroIc", MacroIc::pin_table(), "registers: 64 X and 64 Y words"));
  place("clock_select", drawing("ClockSelect", ClockSelect::pin_table(), ""));
  place("host_port", drawing("HostPort", HostPort::pin_table(), "host: 8 bytes; cpu: 6 words"));
  place("dpram", drawing("Dpram", Dpram::pin_table(), "host: 65536 bytes; cpu: 32768 words"));
  place("board", drawing("Board", Board::pin_table(0x3), "port_a: words; isa_io, isa_memory: bytes"));
  if (std::getenv("BRICK_WRITE_PAGES") != nullptr) std::ofstream(BRICK_COMPONENTS_PAGE) << page;
  EXPECT_TRUE(page == before) << "docs/components.md is not what the pin tables say; BRICK_WRITE_PAGES=1 writes it";
}

}  // namespace
}  // namespace brick::component
