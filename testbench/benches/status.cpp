// status: each bit of ?, ?? and ??? that has a cause in the machine is set and cleared by that cause, through the host,
// and no other bit changes with it (firmware:5.2 to firmware:5.8). The words at their addresses and the control
// characters say the same. And each error number that a host can provoke, where firmware:6.4 says.
#include <fmt/format.h>

#include "systemc/machine/board_family.h"
#include "testbench/benches/benches.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = kPwmClockHz / 1000;

constexpr std::uint64_t bit(unsigned word, unsigned number) { return std::uint64_t{1} << (24 * (1 - word) + number); }

// `changes`: bits of the first two words that are not as before while the cause acts; the third word has none that
// change with these causes.
struct Cause {
  std::string name;
  std::vector<std::string> begin, end;
  std::uint64_t changes;
};

class Status {
 public:
  Status(BenchContext& b, std::string query, unsigned words, std::vector<std::string> addresses)
      : b_(b), query_(std::move(query)), words_(words), addresses_(std::move(addresses)) {}

  void check(const Cause& cause, bool left_out = false) {
    const Words before = read();
    if (!left_out) commands(cause.begin);
    const Words meanwhile = read();
    const std::string expected = text({before.two ^ cause.changes, before.third});
    compared_.equal(cause.name, text(meanwhile), expected);
    compared_.equal(cause.name + " at its addresses", at_addresses(), expected);
    commands(cause.end);
    compared_.equal(cause.name + ", ended", text(read()), text(before));
  }
  void verdict(const std::string& name, unsigned causes) {
    b_.report.step(name, compared_, 3 * causes, fmt::format("{} compared", compared_.made()));
  }

 private:
  void commands(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      if (line == "wait")
        b_.machine.run_until(b_.machine.now() + 4 * kMillisecond);
      else
        compared_.equal(line, b_.ask(line), "");
    }
  }
  struct Words {
    std::uint64_t two = 0;
    std::string third;
  };
  Words read() {
    const std::string answer = b_.ask(query_);
    if (answer.size() != 6 * words_ || answer.find_first_not_of("0123456789ABCDEF") != std::string::npos) {
      compared_.equal(query_, answer, fmt::format("{} hexadecimal digits", 6 * words_));
      return {};
    }
    return {std::stoull(answer.substr(0, 12), nullptr, 16), answer.substr(12)};
  }
  static std::string text(const Words& words) { return fmt::format("{:012X}{}", words.two, words.third); }
  std::string at_addresses() {
    std::string all;
    for (const std::string& address : addresses_) {
      const std::string word = b_.ask("RH" + address);
      all += std::string(word.size() < 6 ? 6 - word.size() : 0, '0') + word;
    }
    return all;
  }

  BenchContext& b_;
  std::string query_;
  unsigned words_;
  std::vector<std::string> addresses_;
  Comparison compared_;
};

Cause variable(const std::string& name, const std::string& number, unsigned value, unsigned usual, unsigned at) {
  return {name, {fmt::format("{}={}", number, value)}, {fmt::format("{}={}", number, usual)}, bit(0, at)};
}

void motor_bits(BenchContext& b) {
  Status status(b, "#1?", 2, {"X$B0", "Y$C0"});
  const std::vector<Cause> causes = {
      variable("integration mode", "I134", 0, 1, 16),
      variable("activated", "I100", 0, 1, 23),
      variable("extended servo algorithm", "I3300", 1, 0, 20),
      variable("user phase", "I159", 2, 0, 9),
      variable("user servo", "I159", 1, 0, 8),
      variable("alternate source", "I101", 2, 0, 7),
      // what becomes a synchronous motor has no phase reference (motion:3.5/1)
      {"phased", {"I101=1"}, {"I101=0"}, bit(0, 6) | bit(1, 8)},
      variable("offset mode", "I106", 2, 0, 5),
      variable("following", "I106", 1, 0, 4),
      variable("error trigger", "I197", 2, 0, 3),
      variable("software capture", "I197", 1, 0, 2),
      variable("integrator in the velocity loop", "I196", 2, 0, 1),
      variable("alternate output", "I196", 1, 0, 0),
      {"home complete", {"#1HMZ"}, {"#1HM#1K"}, bit(1, 10)},
      {"axis A of C.S. 1", {"&1#1->A"}, {"#1->0"}, bit(1, 15) | bit(1, 16)},
      {"axis B of C.S. 2", {"&2#1->5B"}, {"#1->0"}, bit(1, 15) | bit(1, 17) | bit(1, 20)},
      {"axis C of C.S. 16", {"&16#1->C+1"}, {"#1->0"}, bit(1, 15) | 3 * bit(1, 16) | 15 * bit(1, 20)},
      {"axis V of C.S. 3", {"&3#1->V"}, {"#1->0"}, bit(1, 15) | 4 * bit(1, 16) | 2 * bit(1, 20)},
      {"kinematic axis of C.S. 9", {"&9#1->I"}, {"#1->0"}, bit(1, 15) | 5 * bit(1, 16) | 8 * bit(1, 20)},
      {"axis Z of C.S. 5", {"&5#1->1000Z"}, {"#1->0"}, bit(1, 15) | 7 * bit(1, 16) | 4 * bit(1, 20)},
      {"commutated at the start, without phase reference",
       {"I101=1", "SAVE", "$$$"},
       {"I101=0", "SAVE", "$$$"},
       bit(0, 6) | bit(1, 8)},
  };
  for (const Cause& cause : causes) status.check(cause, b.negative && &cause == &causes.front());
  status.verdict("motor, ?", static_cast<unsigned>(causes.size()));
}

void axis_bits(BenchContext& b) {
  Status status(b, "&2??", 3, {"X$2140", "Y$213F", "Y$2140"});
  constexpr std::uint64_t kXyz = bit(0, 19) | bit(0, 21) | bit(0, 23);
  unsigned causes = 2;
  for (unsigned axis = 0; axis < 9; ++axis) {
    const std::string letter(1, "ABCUVWXYZ"[axis]);
    status.check({"feedrate axis " + letter, {"FRAX(" + letter + ")"}, {"FRAX"}, kXyz ^ bit(0, 7 + 2 * axis)});
    status.check({"incremental " + letter, {"INC(" + letter + ")"}, {"ABS(" + letter + ")"}, bit(0, 6 + 2 * axis)});
    causes += 2;
  }
  status.check({"no feedrate axis", {"NOFRAX"}, {"FRAX(X,Y,Z)"}, kXyz});
  status.check({"arc vector absolute", {"ABS(R)"}, {"INC(R)"}, bit(0, 5)});
  status.verdict("axes of a coordinate system, ??", causes);
}

// A rotary program does what the bit is about.
Cause program(const std::string& name, const std::vector<std::string>& lines, const std::string& start,
              std::uint64_t changes) {
  Cause cause{name, {"&2CLEAR"}, {}, changes};
  cause.begin.insert(cause.begin.end(), lines.begin(), lines.end());
  cause.begin.insert(cause.begin.end(), {start, "wait"});
  cause.end = {"A", "wait", "CLEAR"};
  return cause;
}

void program_bits(BenchContext& b) {
  for (const char* line :
       {"DELETE ALL TEMPS", "&2DEFINE ROTARY 100", "I5287=0 I5288=0 I16=1 I17=3", "B0", "OPEN ROTARY"})
    b.expect(line, "");
  Status status(b, "&2??", 3, {"X$2140", "Y$213F", "Y$2140"});
  constexpr std::uint64_t kRunning = bit(0, 0) | bit(0, 4), kInPosition = bit(1, 17);
  status.check(program("running, waits for lines", {}, "R", kRunning));
  status.check(program("single step, waits for a line", {}, "S", bit(0, 0) | bit(0, 1)));
  status.check(program("move under way", {"X10 F10"}, "R", kRunning | kInPosition));
  status.check(program("dwell", {"DWELL500"}, "R", kRunning | kInPosition | bit(1, 12)));
  status.check(
      program("dwell that waits for its turn", {"X10 F10", "DWELL500"}, "R", kRunning | kInPosition | bit(1, 12)));
  Cause end_of_block = program("end of block", {"X10 F10"}, "R", kRunning | kInPosition | bit(1, 14));
  end_of_block.begin.emplace_back("/");
  status.check(end_of_block);
  Cause by_time = program("moves by time", {"TM500 X10"}, "R", kRunning | kInPosition | bit(0, 3));
  by_time.end = {"A", "wait", "CLEAR", "F1000", "R", "wait", "A", "wait"};
  status.check(by_time);
  Cause rapid = program("RAPID", {"F10 RAPID X20"}, "R", kRunning | kInPosition | bit(1, 1));
  rapid.end = {"A", "wait", "CLEAR", "LINEAR", "R", "wait", "A", "wait"};
  status.check(rapid);
  Cause full{"rotary buffer full", {"X1", "X2", "X3"}, {"CLEAR"}, bit(1, 16)};
  status.check(full);
  // 5 ms to Y0.05, then 1 s, blended into each other.
  Cause blended = program("blended move", {"F10 TA2", "Y0.05", "Y10"}, "R", kRunning | kInPosition | bit(0, 2));
  blended.begin.emplace_back("wait");
  blended.end.insert(blended.end.end(), {"I5287=0", "F1000", "R", "wait", "A", "wait"});
  status.check(blended);
  Cause error = program("run-time error", {"CALL30000"}, "R", bit(1, 22));  // there is no such program
  error.end.insert(error.end.begin(), {"R", "wait"});
  status.check(error);
  status.verdict("programs of a coordinate system, ??", 11);
  b.expect("CLOSE", "");
  b.expect("#1->1000Y #1J/", "");  // at 0.1 counts a ms it stays in position
  b.expect("OPEN ROTARY", "");
  b.machine.run_until(b.machine.now() + 15 * kMillisecond);  // Ixx92, and it is in position
  Status motor(b, "#1?", 2, {"X$B0", "Y$C0"});
  constexpr std::uint64_t kTimed = bit(0, 17) | bit(1, 0), kMoves = bit(0, 13);  // so not in position (motion:6.5/1)
  motor.check(program("dwell of its coordinate system", {"DWELL500"}, "R", kTimed | bit(0, 15)));
  motor.check(program("its move", {"Y10 F0.1"}, "R", kTimed | kMoves));
  motor.check(program("move of an axis without it", {"X10 F10"}, "R", kTimed));
  motor.check(program("dwell that waits", {"Y10 F0.1", "DWELL500"}, "R", kTimed | kMoves));
  motor.verdict("programs, ? of a motor", 4);
  b.expect("CLOSE", "");
  b.expect("#1K #1->0", "");
  b.expect("I16=5 I17=10 DELETE ALL TEMPS", "");
}

void global_bits(BenchContext& b) {
  const std::string source = b.ask("I19");
  b.expect("DEFINE ROTARY 50", "");
  Status status(b, "???", 2, {"X$6", "Y$6"});
  status.check({"rotary buffers open", {"OPEN ROTARY"}, {"CLOSE"}, bit(1, 19) | bit(1, 18)});
  status.check({"binary rotary buffers open", {"OPEN BIN ROT"}, {"CLOSE"}, bit(1, 20)});
  status.check({"motion program open", {"OPEN PROG 5"}, {"CLOSE"}, bit(1, 19) | bit(1, 11)});
  status.check({"fixed buffer full", {"I18=30000", "OPEN PROG 5"}, {"CLOSE", "I18=10"}, bit(1, 19)});
  status.check({"PLC open", {"OPEN PLC 5"}, {"CLOSE"}, bit(1, 17) | bit(1, 11)});
  status.check({"forward kinematic program open", {"OPEN FORWARD"}, {"CLOSE"}, bit(1, 11) | bit(1, 15)});
  status.check({"inverse kinematic program open", {"OPEN INVERSE"}, {"CLOSE"}, bit(1, 11) | bit(1, 14)});
  status.check({"no phase clock", {"I" + source + "=3", "wait"}, {"I" + source + "=0", "wait"}, bit(0, 3)});
  status.verdict("global, ???", 8);
  b.expect("DELETE ALL TEMPS", "");
}

// What ^B, ^C, ^F, ^G, ^P and ^V say of motors 9 to 16 and of all systems, from words that are written for it. Ixx08
// and Ixx09 are 96, so a register of 3,072 is one count (firmware:1.10/8, firmware:5.1). Motors that are activated have
// a word of memory for their encoder: its step is shared out to 256 servo interrupts (motion:1.3/4).
void control_characters(BenchContext& b) {
  constexpr int kMotors = 8, kFirst = 9, kSystems = 16, kCount = 32 * 96, kEncoders = 0x10F0;
  Comparison compared;
  std::string statuses, positions, errors, velocities, systems;
  const auto number = [](double value) {
    std::string text = fmt::format("{:.5f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  };
  const auto say = [&](const std::string& line) { compared.equal(line, b.ask(line), ""); };
  const auto wait = [&b](unsigned ms) { b.machine.run_until(b.machine.now() + ms * kMillisecond); };
  for (int i = 0; i < kMotors; ++i) {
    const int motor = kFirst + i, at = 0x80 * motor, sign = i % 2 == 0 ? 1 : -1;
    const std::string space = i == 0 ? "" : " ";
    const bool activated =
        motor % 3 == 0;  // then the words are the loop's (motion:1.3/2): it stands where it was homed
    const double velocity = sign * (motor + 100) + 0.25;
    say(fmt::format("M8..11->* M8->D:${:X} M9->D:${:X}", at + 0x08, at + 0x0B));
    say(fmt::format("M8={} M9={}", sign * (motor + 5) * kCount, sign * (motor * kCount + kCount / 2)));
    if (activated) {
      say(fmt::format("WX${0:X},0 I{1}03=${0:X} I{1}00=1", kEncoders + i, motor));
      wait(1);
      say(fmt::format("WX${:X},{:.0f}", kEncoders + i, velocity * 256 * 32));
      wait(1);
      say(fmt::format("#{}HMZ", motor));
    }
    statuses += space + (activated ? "850000000400" : "050000000000");
    positions += space + number(activated ? 0 : sign * (motor + 0.5));
    errors += space + number(activated ? 0 : sign * 4.5);
    velocities += space + number(activated ? velocity : 0);
  }
  for (int cs = 1; cs <= kSystems; ++cs) {
    if (cs % 4 == 3) say(fmt::format("&{}INC(V)", cs));
    systems += (cs == 1 ? "" : " ") + std::string(cs % 4 == 3 ? "A84020" : "A80020") + "020000000000";
  }
  say("I68=15 ##1");
  wait(8);  // the next of sixteen samples
  const auto line = [&b](std::uint8_t c) {
    const Reply reply = b.link.control(c);
    return reply.lines.empty() ? "nothing" : reply.lines.front();
  };
  const bool ultralite = (b.board.product & kProductUltralite) != 0, umac = (b.board.product & kProductUmac) != 0;
  const std::uint64_t global = bit(1, 11) | (ultralite ? bit(1, 23) : 0) | (umac ? bit(1, 16) : 0);
  compared.equal("^B", line(0x02), statuses);
  compared.equal("^C", line(0x03), systems);
  compared.equal("^G", line(0x07), fmt::format("{:012X}", global));
  compared.equal("^P", line(0x10), positions);
  compared.equal("^F", line(0x06), errors);
  compared.equal("^V", line(0x16), velocities);
  for (int motor = kFirst; motor < kFirst + kMotors; ++motor)
    if (motor % 3 == 0) say(fmt::format("#{0}HM I{0}00=0 I{0}03=${1:X}", motor, 0x3500 + motor));
  for (int cs = 3; cs <= kSystems; cs += 4) say(fmt::format("&{}ABS(V)", cs));
  say("M8..11->* ##0");
  b.report.step("control characters", compared, 6, "^B ^C ^F ^G ^P ^V say what was written for them");
}

void errors(BenchContext& b) {
  struct {
    const char *line, *answer;
  } const kLines[] = {{"UUU", "ERR003"},
                      {"P1=\xC4", "ERR004"},
                      {"X10", "ERR005"},
                      {"OPEN PLC 1", ""},
                      {"ENDIF", "ERR009"},
                      {"IF(P1=1)", ""},
                      {"CLOSE", "ERR009"},
                      {"&1DEFINE ROTARY 3", ""},
                      {"&2DEFINE ROTARY 3", "ERR003"},
                      {"&1B0 OPEN ROTARY", ""},
                      {"X1Y2Z3A4", "ERR006"},
                      {"OPEN PLC 1", "ERR007"},
                      {"&5X1", "ERR006"},
                      {"&1CLOSE", ""},
                      {"MS1,I912", "ERR008"},
                      {"&1#2->X", ""},
                      {"R", "ERR013"},
                      {"#2J+", "ERR013"},
                      {"#2->0", ""},
                      {"&4R", "ERR015"},
                      {"&1R", ""},
                      {"DEFINE LOOKAHEAD 5,5", "ERR001"},
                      {"OPEN PROG 1", "ERR001"},
                      {"#1->X", "ERR001"},
                      {"SAVE", "ERR001"},
                      {"P7=1 UUU P7=2", "ERR003"},
                      {"P7", "1"},
                      {"A DELETE ALL TEMPS", ""},
                      {"DEFINE GATHER 30000", "ERR006"},
                      {"OPEN PROG 3 CLEAR", ""},
                      {"IF(P1=1)", ""},
                      {"CLOSE", "ERR009"},
                      {"B3R", "ERR016"},
                      {"OPEN PROG 3 CLEAR CLOSE", ""},
                      {"B3R", "ERR015"},
                      {"FSAVE", "ERR003"},
                      {"FREAD", "ERR003"}};
  Comparison compared;
  for (const auto& [line, answer] : kLines) compared.equal(line, b.ask(line), answer);
  b.report.step("error numbers", compared, std::size(kLines), "001 003 to 009 013 015 016 where they have to be");
}

void run(BenchContext& b) {
  // Whatever stands at the flags of motor 1 is no fault and no limit: what a cause closes stays closed.
  const std::string mode = b.ask("I124");
  b.expect("I124=I124|$120000", "");
  motor_bits(b);
  axis_bits(b);
  program_bits(b);
  global_bits(b);
  control_characters(b);
  errors(b);
  b.expect("I124=" + mode, "");
  b.report.equal<std::string>("problems in ???", b.problems(), "none");
}

}  // namespace

// covers: BREQ-5 I18-1
Bench status_bench() {
  return {"status",
          "each bit of ?, ??, ??? set and cleared by its cause and no other with it; error numbers",
          {"the first cause is left out", "motor, ?", "integration mode: 850000000000, expected 840000000000"},
          run};
}

}  // namespace brick
