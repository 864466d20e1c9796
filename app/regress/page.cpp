// The page with the results: one file, which page.html is with the report in it.
#include <nlohmann/json.hpp>

#include "app/regress/report.h"
#include "regress_page.h"  // made of page.html

namespace brick::regress {

std::string page_text(const nlohmann::json& report) {
  constexpr const char* kPlace = "@REPORT@";
  std::string content, page = kRegressPage;
  for (const char c : report.dump())  // no tag of it ends the script it stands in
    content += c == '<' ? std::string("\\u003c") : std::string(1, c);
  const std::size_t at = page.find(kPlace);
  return page.replace(at, std::string(kPlace).size(), content);
}

}  // namespace brick::regress
