#include "app/page/site.h"

#include <fmt/format.h>

#include "page_site.h"  // made of app/page/site

namespace brick {

namespace {

void put(std::string& page, const std::string& place, const std::string& content) {
  for (std::size_t at = page.find(place); at != std::string::npos; at = page.find(place, at + content.size()))
    page.replace(at, place.size(), content);
}

}  // namespace

std::string site_html(const std::string& nonce, bool read_only) {
  std::string page = kSiteHtml;
  put(page, "@NONCE@", nonce);
  put(page, "@MODE@", read_only ? "read-only" : "full");
  put(page, "@STYLE@", kSiteStyle);
  put(page, "@SCRIPT@", fmt::format("{}{}{}", kSiteStatus, kSitePlots, kSiteScript));
  return page;
}

std::string site_policy(const std::string& nonce) {
  return fmt::format(
      "default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; img-src data:; connect-src 'self'; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      nonce);
}

}  // namespace brick
