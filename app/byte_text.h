// What the controller sent, as people can read it.
#pragma once

#include <string>
#include <string_view>

namespace brick {

std::string visible_bytes(std::string_view bytes);  // control bytes as <06>
std::string beginning_of(std::string_view bytes);   // in quotation marks; of what is long the beginning, and how long
                                                    // it is
}  // namespace brick
