#include "testbench/unit/firmware_program/platform.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>

namespace {

std::map<std::uint32_t, std::uint32_t> x_memory, y_memory;
std::array<double, VARIABLE_COUNT> i_values, p_values, m_values;
std::array<std::array<double, VARIABLE_COUNT>, 16> q_values;
double cycles = 0.0;
std::uint32_t signals = 0;
std::vector<platform::Edge> edge_list;
std::uint32_t mask_level = 0;  // 0 none, 1 real-time task, 2 servo task too
double masked_since = 0.0, longest_mask = 0.0;
std::uint32_t cs_number = 0, motor_number = 0, generation = 0;
std::string reply;
std::uint32_t servo_count = 0;
std::uint32_t product = 0;  // strap word

constexpr std::uint32_t kPanelPort = 0x078800, kPanelIdle = 0x00FFFF;

double now_us() { return cycles / platform::kCyclesPerUs; }

std::uint32_t raise_mask(std::uint32_t level) {
  const std::uint32_t before = mask_level;
  if (before == 0) masked_since = now_us();
  mask_level = std::max(mask_level, level);
  return before;
}

std::uint32_t address_number(lexer* lx) {
  double number = 1.0;
  return lexer_number(lx, &number) ? static_cast<std::uint32_t>(number) - 1 : 0;
}

// I, P or Q with a number: assignment or query. False: the text is something else.
bool variable_command(lexer* lx, error_t* error) {
  const lexer start = *lx;
  std::uint32_t group = 0;
  for (const char letter : {'M', 'P', 'Q', 'I'}) {
    double number = 0.0;
    if (lexer_accept(lx, letter)) {
      if (!lexer_number(lx, &number)) break;
      if (lexer_accept(lx, '=')) {
        double value = 0.0;
        *error = expression_evaluate(lx, cs_number, &value);
        if (*error == ERR_NONE) variable_write(group, cs_number, number, value);
        buffer_request_evaluate();
      } else {
        reply_number(variable_read(group, cs_number, number));
        reply_end_line();
        *error = ERR_NONE;
      }
      return true;
    }
    ++group;
  }
  *lx = start;
  return false;
}

error_t table_command(lexer* lx) {
  for (const command_entry* entry = program_commands; entry->keyword != nullptr; ++entry)
    if (lexer_keyword(lx, entry->keyword)) return entry->run(lx);
  if (lexer_keyword(lx, "???")) {
    reply_hex(motion_global_status2(), 6);
  } else if (lexer_keyword(lx, "??")) {
    for (unsigned word = 0; word < 3; ++word) reply_hex(motion_cs_status(cs_number, word), 6);
  } else {
    return program_starts_statement(*lx) ? ERR_NEEDS_BUFFER : ERR_DATA;
  }
  reply_end_line();
  return ERR_NONE;
}

error_t one_command(lexer* lx) {
  error_t error = ERR_NONE;
  if (lexer_accept(lx, '&')) {
    cs_number = address_number(lx);
    ++generation;
    buffer_request_evaluate();
    return ERR_NONE;
  }
  if (lexer_accept(lx, '#')) {
    motor_number = address_number(lx);
    return ERR_NONE;
  }
  if (program_buffer_open() && program_starts_statement(*lx)) return program_statement(lx);
  if (variable_command(lx, &error)) return error;
  return table_command(lx);
}

}  // namespace

extern "C" {

volatile std::uint32_t* hal_x(std::uint32_t address) { return &x_memory[address]; }
volatile std::uint32_t* hal_y(std::uint32_t address) { return &y_memory[address]; }

std::uint32_t hal_mask_real_time(void) { return raise_mask(1); }
std::uint32_t hal_mask_servo(void) { return raise_mask(2); }
void hal_unmask(std::uint32_t state) {
  mask_level = state;
  if (state == 0) longest_mask = std::max(longest_mask, now_us() - masked_since);
}

std::uint32_t hal_strap(unsigned word) { return word == HAL_STRAP_PRODUCT ? product : 0; }

std::uint32_t hal_cycles(void) { return static_cast<std::uint32_t>(static_cast<std::uint64_t>(cycles)); }
void hal_delay_us(std::uint32_t us) { cycles += us * platform::kCyclesPerUs; }
void hal_host_signals(std::uint32_t set, std::uint32_t clear) {
  const std::uint32_t before = signals;
  signals = (signals | set) & ~clear;
  if (((before ^ signals) & HAL_SIGNAL_BREQ) != 0) edge_list.push_back({(signals & HAL_SIGNAL_BREQ) != 0, now_us()});
}

double i_variable_read(std::uint32_t number) { return i_values.at(number); }
void i_variable_write(std::uint32_t number, double value) { i_values.at(number) = value; }
std::int32_t i_integer(std::uint32_t number) { return static_cast<std::int32_t>(i_values.at(number)); }
double p_variable_read(std::uint32_t number) { return p_values.at(number); }
void p_variable_write(std::uint32_t number, double value) { p_values.at(number) = value; }
double q_variable_read(std::uint32_t cs, std::uint32_t number) { return q_values.at(cs).at(number); }
void q_variable_write(std::uint32_t cs, std::uint32_t number, double value) { q_values.at(cs).at(number) = value; }
double m_variable_read(std::uint32_t number) { return m_values.at(number); }
void m_variable_write(std::uint32_t number, double value) { m_values.at(number) = value; }

std::uint32_t command_cs(void) { return cs_number; }
std::uint32_t command_motor(void) { return motor_number; }
std::uint32_t command_generation(void) { return generation; }

void reply_text(const char* text) { reply += text; }
void reply_char(char c) { reply += c; }
void reply_integer(std::int64_t value) { reply += std::to_string(value); }
void reply_hex(std::uint32_t value, unsigned digits) {
  char text[16];
  std::snprintf(text, sizeof text, "%0*X", static_cast<int>(digits), value);
  reply += text;
}
void reply_number(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.10f", value);
  std::string s = text;
  s.erase(s.find_last_not_of('0') + 1);
  if (s.back() == '.') s.pop_back();
  reply += s;
}
void reply_end_line(void) { reply += '|'; }
}

namespace platform {

void power_up() {
  x_memory.clear();
  y_memory.clear();
  i_values.fill(0.0);
  p_values.fill(0.0);
  m_values.fill(0.0);
  for (auto& q : q_values) q.fill(0.0);
  i_values[8] = 2;
  i_values[10] = kDefaultI10;
  i_values[16] = 5;
  i_values[17] = 10;
  for (std::uint32_t cs = 0; cs < 16; ++cs) {  // firmware:3.4
    double* isx = &i_values[5100 + 100 * cs];
    isx[88] = 50;
    isx[89] = isx[90] = 1000;
    isx[94] = isx[95] = 1644;
  }
  cycles = 0.0;
  mask_level = 0;
  longest_mask = 0.0;
  cs_number = motor_number = generation = servo_count = 0;
  product = 0;
  panel_initialize();
  motion_initialize();
  edge_list.clear();
}

std::string host(const std::string& line) {
  std::string text = line;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  reply.clear();
  lexer lx{text.c_str()};
  error_t error = ERR_NONE;
  program_line_begin();
  while (error == ERR_NONE && lexer_peek(&lx) != 0) error = one_command(&lx);
  if (error == ERR_NONE)
    error = program_line_commit();
  else
    program_line_abandon();
  if (error != ERR_NONE) {
    char number[16];
    std::snprintf(number, sizeof number, "ERR%03d", static_cast<int>(error));
    return number;
  }
  if (!reply.empty()) reply.pop_back();
  return reply;
}

void pass_us(double us) { cycles += us * kCyclesPerUs; }

void real_time() {
  EXPECT_EQ(mask_level, 0u) << "a section that holds the real-time task off was not left";
  motion_real_time_update();
}

void servo_ticks(unsigned count) {
  const unsigned period = static_cast<unsigned>(i_values[8]) + 1;
  for (unsigned i = 0; i < count; ++i) {
    motion_servo_update();
    if (++servo_count % period == 0) real_time();
  }
}

bool breq() { return (signals & HAL_SIGNAL_BREQ) != 0; }
std::vector<Edge>& edges() { return edge_list; }
double longest_mask_us() { return longest_mask; }
void fit_panel() {
  product = HAL_PRODUCT_JPAN;
  y_memory[kPanelPort] = kPanelIdle;
  panel_initialize();
  buffer_request_evaluate();
}

void panel(std::uint32_t low) {
  y_memory[kPanelPort] = kPanelIdle & ~low;
  panel_pass();
  buffer_request_poll();
}

void set_i(std::uint32_t number, double value) { i_values.at(number) = value; }

}  // namespace platform
