// The page itself: one file of HTML, made of app/page/site at build time.
#pragma once

#include <string>

namespace brick {

std::string site_html(const std::string& nonce, bool read_only);
std::string site_policy(const std::string& nonce);  // Content-Security-Policy: it loads nothing from anywhere

}  // namespace brick
