// The page with the results: one file, which page.html is with the report in it.
#include <nlohmann/json.hpp>

#include "app/regress/report.h"
#include "regress_page.h"  // made of page.html

namespace brick::regress {

namespace {

// No tag of it ends the script it stands in.
void put(std::string& page, const std::string& place, const nlohmann::json& content) {
  std::string text;
  for (const char c : text_of(content)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  page.replace(page.find(place), place.size(), text);
}

}  // namespace

std::string page_text(const nlohmann::json& report, const nlohmann::json& pictures) {
  std::string page = kRegressPage;
  put(page, "@PICTURES@", pictures);
  put(page, "@REPORT@", report);
  return page;
}

}  // namespace brick::regress
