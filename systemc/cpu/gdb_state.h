// Inside of the GDB server: what the debugger has set, and whether the program runs. Private to this folder.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "systemc/cpu/gdb_link.h"
#include "systemc/cpu/gdb_server.h"

namespace brick {

struct GdbServer::Impl {
  Impl(Cpu& modelled, std::uint16_t port) : cpu(modelled), link(port) {}

  // gdb_server.cpp: run control
  Cpu::Stop run(Cycle limit);
  Cpu::Stop one_instruction();
  void before_instruction();
  std::string stop_reason();  // "" = go on
  void look();
  void stop(const std::string& reason);
  void raise(unsigned number, const std::string& text);
  void serve();
  void detach();
  bool stepwise() const {
    return pending == Pending::kSignal || stepping || !breakpoints[0].empty() || !breakpoints[1].empty() ||
           !watches.empty();
  }

  // gdb_commands.cpp: what each packet does. No answer: the program is resumed or the debugger has gone.
  std::optional<std::string> answer(std::string_view packet);
  std::optional<std::string> resume(char action, std::string_view at);
  std::string query(std::string_view packet);
  std::string monitor(std::string_view command);
  std::string read_registers();
  std::string write_registers(std::string_view text);
  std::string read_register(std::string_view text);
  std::string write_register(std::string_view text);
  std::string read_memory(std::string_view text);
  std::string write_memory(std::string_view text, bool binary);
  std::string change_point(bool set, std::string_view text);
  std::string trap_reason(const std::string& detail) const { return "T05" + detail + "thread:1;"; }

  Cpu& cpu;
  GdbLink link;
  std::function<std::string()> on_time;

  enum class Pending { kNone, kBreak, kAttach, kSignal } pending = Pending::kNone;
  unsigned signal = 0;     // GDB's number, of kSignal
  std::string console;     // what a signal has to say
  bool waiting = true;     // for the first debugger
  bool resumed = false;    // set by the packet that lets the program go on
  bool stop_owed = false;  // the program runs and a connected debugger waits for news
  std::string last_stop = "T05thread:1;";
  std::chrono::steady_clock::time_point last_look;
  unsigned since_look = 0;

  std::unordered_set<std::uint32_t> breakpoints[2];  // software, hardware: both are looked up, none is in memory
  enum class Kind { kWrite, kRead, kAccess };
  struct Watch {
    Kind kind;
    std::uint32_t address, bytes;
    bool operator==(const Watch& o) const { return kind == o.kind && address == o.address && bytes == o.bytes; }
  };
  std::vector<Watch> watches;
  std::string watch_hit;  // what to report before the next instruction

  // Where the program was resumed; a breakpoint there counts only when it is reached again.
  std::uint32_t resume_pc = 0;
  std::uint64_t resume_count = 0;
  // A step goes through interrupt handlers: it ends after an instruction of the code that it began in.
  bool stepping = false, in_handler = false;
  std::uint32_t step_sp = 0;
};

}  // namespace brick
