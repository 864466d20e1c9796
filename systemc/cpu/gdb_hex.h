// Reading and writing the hexadecimal text of GDB packets. Values in memory order are little-endian, as the CPU is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace brick::gdb {

inline int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

inline void put_byte(std::string& text, std::uint8_t v) {
  constexpr const char* kDigits = "0123456789abcdef";
  text += kDigits[v >> 4];
  text += kDigits[v & 15];
}

inline void put_word(std::string& text, std::uint32_t v) {
  for (unsigned i = 0; i < 4; ++i) put_byte(text, static_cast<std::uint8_t>(v >> 8 * i));
}

inline std::string encode(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) put_byte(text, static_cast<std::uint8_t>(c));
  return text;
}

// The bytes that a text of whole digit pairs stands for.
inline std::optional<std::string> decode_bytes(std::string_view text) {
  if (text.size() % 2 != 0) return {};
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const int high = digit(text[i]), low = digit(text[i + 1]);
    if (high < 0 || low < 0) return {};
    bytes += static_cast<char>(16 * high + low);
  }
  return bytes;
}

inline std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t v = 0;
  for (unsigned i = 0; i < 4; ++i) v |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << 8 * i;
  return v;
}

// Takes a number of one to eight digits from the front; false leaves the rest undefined.
inline bool take_number(std::string_view& text, std::uint32_t& v) {
  v = 0;
  std::size_t n = 0;
  for (; n < text.size() && digit(text[n]) >= 0; ++n) v = v << 4 | static_cast<std::uint32_t>(digit(text[n]));
  text.remove_prefix(n);
  return n > 0 && n <= 8;
}

inline bool take(std::string_view& text, std::string_view start) {
  if (text.substr(0, start.size()) != start) return false;
  text.remove_prefix(start.size());
  return true;
}

}  // namespace brick::gdb
