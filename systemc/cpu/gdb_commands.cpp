// The packets of the GDB remote serial protocol: registers, memory, breakpoints, queries. A packet that is not known
// gets the empty answer, one that is known and wrong E01, as the protocol asks.
#include <algorithm>
#include <cstring>

#include "systemc/cpu/gdb_hex.h"
#include "systemc/cpu/gdb_state.h"

namespace brick {

using namespace gdb;

namespace {

constexpr unsigned kGeneral = 32;   // x0 to x31; the next number is pc
constexpr unsigned kFirstCsr = 65;  // GDB's number of CSR 0
constexpr const char* kError = "E01";

struct NamedCsr {
  const char* name;
  unsigned number;
};
constexpr NamedCsr kCsrs[] = {{"mstatus", 0x300}, {"mie", 0x304},    {"mtvec", 0x305}, {"mscratch", 0x340},
                              {"mepc", 0x341},    {"mcause", 0x342}, {"mtval", 0x343}, {"mip", 0x344}};

std::string target_description() {
  constexpr const char* kNames[kGeneral] = {"zero", "ra", "sp", "gp", "tp",  "t0",  "t1", "t2", "fp", "s1", "a0",
                                            "a1",   "a2", "a3", "a4", "a5",  "a6",  "a7", "s2", "s3", "s4", "s5",
                                            "s6",   "s7", "s8", "s9", "s10", "s11", "t3", "t4", "t5", "t6"};
  std::string xml =
      "<?xml version=\"1.0\"?><!DOCTYPE target SYSTEM \"gdb-target.dtd\"><target version=\"1.0\">"
      "<architecture>riscv:rv32</architecture><feature name=\"org.gnu.gdb.riscv.cpu\">";
  const auto add = [&](const std::string& name, const std::string& type, unsigned number) {
    xml +=
        "<reg name=\"" + name + "\" bitsize=\"32\" type=\"" + type + "\" regnum=\"" + std::to_string(number) + "\"/>";
  };
  for (unsigned i = 0; i < kGeneral; ++i) {
    const std::string name = kNames[i];
    add(name,
        name == "ra"                                                   ? "code_ptr"
        : name == "sp" || name == "fp" || name == "gp" || name == "tp" ? "data_ptr"
                                                                       : "int",
        i);
  }
  add("pc", "code_ptr", kGeneral);
  xml += "</feature><feature name=\"org.gnu.gdb.riscv.csr\">";
  for (const NamedCsr& csr : kCsrs) add(csr.name, "int", kFirstCsr + csr.number);
  return xml + "</feature></target>";
}

}  // namespace

std::optional<std::string> GdbServer::Impl::answer(std::string_view packet) {
  if (packet.empty()) return "";
  const std::string_view rest = packet.substr(1);
  switch (packet[0]) {
    case '?':
      return last_stop;
    case 'g':
      return read_registers();
    case 'G':
      return write_registers(rest);
    case 'p':
      return read_register(rest);
    case 'P':
      return write_register(rest);
    case 'm':
      return read_memory(rest);
    case 'M':
      return write_memory(rest, false);
    case 'X':
      return write_memory(rest, true);
    case 'Z':
      return change_point(true, rest);
    case 'z':
      return change_point(false, rest);
    case 'c':
    case 's':
      return resume(packet[0], rest);
    case 'C':
    case 'S': {  // with a signal, which means nothing here
      const std::size_t at = rest.find(';');
      return resume(packet[0] == 'C' ? 'c' : 's', at == rest.npos ? "" : rest.substr(at + 1));
    }
    case 'H':
    case 'T':  // one thread, and it lives
      return "OK";
    case 'D':
      link.send("OK");
      detach();
      return {};
    case 'k':
      link.close();
      throw GdbKilled();
    default:
      break;
  }
  if (packet == "vCont?") return "vCont;c;C;s;S";
  if (std::string_view actions = packet; take(actions, "vCont;")) {
    // One thread: the first action is the one that counts for it.
    const char action = actions.empty() ? ' ' : actions[0];
    if (action == 'c' || action == 'C') return resume('c', "");
    if (action == 's' || action == 'S') return resume('s', "");
    return kError;
  }
  if (packet == "QStartNoAckMode") {
    link.send("OK");
    link.stop_acks();
    return {};
  }
  if (packet[0] == 'q') return query(packet);
  return "";
}

std::optional<std::string> GdbServer::Impl::resume(char action, std::string_view at) {
  resume_pc = cpu.pc();
  resume_count = cpu.instructions();
  if (!at.empty()) {
    std::uint32_t pc = 0;
    if (!take_number(at, pc) || !at.empty()) return kError;
    cpu.set_pc(pc);
    resume_pc = cpu.pc();
  }
  step_sp = cpu.reg(2);
  stepping = action == 's';
  resumed = stop_owed = true;
  return {};
}

std::string GdbServer::Impl::query(std::string_view packet) {
  if (take(packet, "qSupported")) {
    std::string size;
    for (unsigned shift = 16; shift > 0; shift -= 8)
      put_byte(size, static_cast<std::uint8_t>(GdbLink::kMaxPacket >> (shift - 8)));
    return "PacketSize=" + size + ";qXfer:features:read+;swbreak+;hwbreak+;vContSupported+;QStartNoAckMode+";
  }
  if (packet == "qAttached") return "1";  // so that a debugger which leaves lets the program run on
  if (packet == "qC") return "QC1";
  if (packet == "qfThreadInfo") return "m1";
  if (packet == "qsThreadInfo") return "l";
  if (take(packet, "qRcmd,")) {
    const auto command = decode_bytes(packet);
    return command ? encode(monitor(*command)) : kError;
  }
  if (take(packet, "qXfer:features:read:")) {
    std::uint32_t from = 0, count = 0;
    if (!take(packet, "target.xml:")) return "E00";
    if (!take_number(packet, from) || !take(packet, ",") || !take_number(packet, count) || !packet.empty())
      return kError;
    const std::string xml = target_description();
    if (from >= xml.size()) return "l";
    const std::string piece = xml.substr(from, std::min<std::size_t>(count, GdbLink::kMaxPacket / 2));
    return (from + piece.size() < xml.size() ? "m" : "l") + piece;
  }
  return "";
}

std::string GdbServer::Impl::monitor(std::string_view command) {
  if (command == "time") return (on_time ? on_time() : std::to_string(cpu.cycle()) + " cycles") + "\n";
  const std::string help = "time  simulated time\nhelp  this list\n";
  return command == "help" || command.empty() ? help : "no such command; expected one of:\n" + help;
}

std::string GdbServer::Impl::read_registers() {
  std::string text;
  for (unsigned i = 0; i < kGeneral; ++i) put_word(text, cpu.reg(i));
  put_word(text, cpu.pc());
  return text;
}

std::string GdbServer::Impl::write_registers(std::string_view text) {
  const auto bytes = decode_bytes(text);
  if (!bytes || bytes->size() != 4 * (kGeneral + 1)) return kError;
  for (unsigned i = 0; i < kGeneral; ++i) cpu.set_reg(i, word_at(*bytes, 4 * i));
  cpu.set_pc(word_at(*bytes, 4 * kGeneral));
  return "OK";
}

std::string GdbServer::Impl::read_register(std::string_view text) {
  std::uint32_t number = 0;
  if (!take_number(text, number) || !text.empty()) return kError;
  std::string value;
  if (number < kGeneral) {
    put_word(value, cpu.reg(number));
  } else if (number == kGeneral) {
    put_word(value, cpu.pc());
  } else {
    const bool known = std::any_of(std::begin(kCsrs), std::end(kCsrs),
                                   [&](const NamedCsr& c) { return kFirstCsr + c.number == number; });
    if (!known) return kError;
    put_word(value, cpu.csr(number - kFirstCsr));
  }
  return value;
}

// Control and status registers are read-only here: the machine owns the interrupt bits among them.
std::string GdbServer::Impl::write_register(std::string_view text) {
  std::uint32_t number = 0;
  if (!take_number(text, number) || number > kGeneral || !take(text, "=")) return kError;
  const auto bytes = decode_bytes(text);
  if (!bytes || bytes->size() != 4) return kError;
  if (number == kGeneral)
    cpu.set_pc(word_at(*bytes, 0));
  else
    cpu.set_reg(number, word_at(*bytes, 0));
  return "OK";
}

// Only plain memory: reading a device register may change the device, and takes a bus cycle of simulated time.
std::string GdbServer::Impl::read_memory(std::string_view text) {
  std::uint32_t address = 0, count = 0;
  if (!take_number(text, address) || !take(text, ",") || !take_number(text, count) || !text.empty()) return kError;
  count = std::min<std::uint32_t>(count, GdbLink::kMaxPacket / 2);
  std::string bytes;
  for (const Cpu::Mapping& m : cpu.mappings()) {
    if (address < m.base || address - m.base >= m.bytes) continue;
    count = std::min(count, m.bytes - (address - m.base));  // fewer than asked for is allowed
    const std::uint8_t* memory = cpu.memory(address, count);
    if (memory == nullptr) return kError;
    for (std::uint32_t i = 0; i < count; ++i) put_byte(bytes, memory[i]);
    return bytes;
  }
  return kError;
}

std::string GdbServer::Impl::write_memory(std::string_view text, bool binary) {
  std::uint32_t address = 0, count = 0;
  if (!take_number(text, address) || !take(text, ",") || !take_number(text, count) || !take(text, ":")) return kError;
  const auto bytes = binary ? std::optional<std::string>(text) : decode_bytes(text);
  if (!bytes || bytes->size() != count) return kError;
  if (count == 0) return "OK";  // asks whether X is understood
  std::uint8_t* memory = cpu.memory(address, count);
  if (memory == nullptr) return kError;
  bool mask24 = false;
  for (const Cpu::Mapping& m : cpu.mappings())
    mask24 = mask24 || (m.mask24 && address >= m.base && address - m.base < m.bytes);
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool missing = mask24 && (address + i) % 4 == 3;  // PMAC words have 24 bits
    memory[i] = missing ? 0 : static_cast<std::uint8_t>((*bytes)[i]);
  }
  cpu.invalidate_code();
  return "OK";
}

std::string GdbServer::Impl::change_point(bool set, std::string_view text) {
  if (text.empty() || text[0] < '0' || text[0] > '4') return "";
  const unsigned type = static_cast<unsigned>(text[0] - '0');
  std::uint32_t address = 0, kind = 0;
  text.remove_prefix(1);
  if (!take(text, ",") || !take_number(text, address) || !take(text, ",") || !take_number(text, kind)) return kError;
  if (!text.empty() && text[0] != ';') return kError;
  if (text.size() > 1) return "";  // conditions and commands run in the target: not built, the debugger does them
  if (type < 2) {
    if (set)
      breakpoints[type].insert(address);
    else
      breakpoints[type].erase(address);
    return "OK";
  }
  if (kind == 0) return kError;
  const Watch watch{type == 2 ? Kind::kWrite : type == 3 ? Kind::kRead : Kind::kAccess, address, kind};
  watches.erase(std::remove(watches.begin(), watches.end(), watch), watches.end());
  if (set) watches.push_back(watch);
  return "OK";
}

}  // namespace brick
