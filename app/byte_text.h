// What the controller sent and what stands in files, as people can read it: a terminal gets no byte of it that acts.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace brick {

std::string visible_bytes(std::string_view bytes);  // all but printable ASCII as <06>
std::string utf8_text(std::string_view bytes);      // what is no UTF-8 as <F9>
std::string readable_text(std::string_view bytes);  // what is no UTF-8, and control characters, as <06>

// For messages, of what is long the beginning: readable, without and with quotation marks and how long it is.
std::string cut_text(std::string_view bytes, std::size_t most = 60);
std::string beginning_of(std::string_view bytes, std::size_t most = 60);

}  // namespace brick
