// Who may have the page, and what may be asked for: no sockets.
#include <gtest/gtest.h>

#include "app/page/page_message.h"
#include "app/page/page_rules.h"

namespace brick {
namespace {

const char* const kToken = "0123456789abcdef0123456789abcdef";
const std::string kQuery = std::string("?token=") + kToken;

PageRequest request(const std::string& host, const std::string& origin = "") {
  PageRequest one{"GET", "/" + kQuery, {host}, {}, false};
  if (!origin.empty()) one.origins.push_back(origin);
  return one;
}

PageRequest upgrade(const std::string& host, const std::string& origin) {
  PageRequest one = request(host, origin);
  one.target = "/socket" + kQuery;
  one.upgrade = true;
  return one;
}

TEST(PageRules, LetsThePageItselfIn) {
  const PageRules rules("127.0.0.1", "127.0.0.1", 8080, kToken);
  EXPECT_FALSE(rules.beyond_loopback());
  EXPECT_EQ(rules.address(), "http://127.0.0.1:8080/" + kQuery);
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080"}) {
    EXPECT_EQ(rules.judge(request(host)).status, 200u) << host;
    EXPECT_EQ(rules.judge(upgrade(host, std::string("http://") + host)).status, 200u) << host;
  }
}

TEST(PageRules, KeepsOtherHostsOut) {
  const PageRules rules("127.0.0.1", "127.0.0.1", 8080, kToken);
  for (const char* host : {"127.0.0.1", "127.0.0.1:80", "evil.example:8080", "127.0.0.1.evil.example:8080", "", ":8080",
                           "10.0.0.1:8080", "127.0.0.1:8080:8080", "localhost.:8080"})
    EXPECT_EQ(rules.judge(request(host)).status, 403u) << host;
  PageRequest two = request("127.0.0.1:8080");
  two.hosts.emplace_back("127.0.0.1:8080");
  EXPECT_EQ(rules.judge(two).status, 403u);
  two.hosts.clear();
  EXPECT_EQ(rules.judge(two).status, 403u);
}

TEST(PageRules, KeepsOtherSitesOut) {
  const PageRules rules("127.0.0.1", "127.0.0.1", 8080, kToken);
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8080", "http://127.0.0.1",
                             "http://127.0.0.1:80801", "http://localhost:8080", "127.0.0.1:8080"}) {
    EXPECT_EQ(rules.judge(request("127.0.0.1:8080", origin)).status, 403u) << origin;
    EXPECT_EQ(rules.judge(upgrade("127.0.0.1:8080", origin)).status, 403u) << origin;
  }
  EXPECT_EQ(rules.judge(upgrade("127.0.0.1:8080", "")).status, 403u) << "a websocket has an origin";
}

TEST(PageRules, AsksForAllOfTheToken) {
  const PageRules rules("127.0.0.1", "127.0.0.1", 8080, kToken);
  for (const std::string& target :
       {std::string("/"), std::string("/?token="), std::string("/?"), "/" + kQuery + "0", ("/" + kQuery).substr(0, 20),
        "/?a=1&token=" + std::string(kToken), "/?token=" + std::string(32, '0')}) {
    PageRequest one = request("127.0.0.1:8080");
    one.target = target;
    EXPECT_EQ(rules.judge(one).status, 403u) << target;
  }
  PageRequest one = request("127.0.0.1:8080");
  one.target = "/socket" + kQuery;
  EXPECT_EQ(rules.judge(one).status, 404u) << "no websocket";
  one.method = "POST";
  EXPECT_EQ(rules.judge(one).status, 405u);
}

TEST(PageRules, BeyondThisMachineByItsNameOrByAnyAddress) {
  const PageRules named("Lab.example", "10.1.2.3", 80, kToken);
  EXPECT_TRUE(named.beyond_loopback());
  for (const char* host : {"lab.example:80", "10.1.2.3:80", "lab.example"})
    EXPECT_EQ(named.judge(request(host)).status, 200u) << host;
  EXPECT_EQ(named.judge(request("localhost:80")).status, 403u);
  const PageRules all("0.0.0.0", "0.0.0.0", 8080, kToken);
  EXPECT_TRUE(all.beyond_loopback());
  EXPECT_EQ(all.address(), "http://127.0.0.1:8080/" + kQuery);
  EXPECT_EQ(all.judge(request("10.9.8.7:8080")).status, 200u);
  EXPECT_EQ(all.judge(request("evil.example:8080")).status, 403u) << "a name may be anybody's";
}

TEST(PageRules, TokensAreRandom) {
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, random_token());
}

TEST(PageMessages, AreCommandsAndWatchLists) {
  const auto command = std::get<PageCommand>(parse_page_message(R"({"kind":"command","id":7,"line":"#1J+"})"));
  EXPECT_EQ(command.id, 7);
  EXPECT_EQ(command.line, "#1J+");
  const auto watch = std::get<PageWatch>(parse_page_message(R"({"kind":"watch","items":["X:$0","host.breq"]})"));
  EXPECT_EQ(watch.items, (std::vector<std::string>{"X:$0", "host.breq"}));
  const std::string longest(255, 'P');
  EXPECT_EQ(std::get<PageCommand>(parse_page_message(R"({"kind":"command","id":0,"line":")" + longest + "\"}")).line,
            longest);
}

TEST(PageMessages, RefusesWhatIsNone) {
  for (const std::string& text :
       {std::string(""), std::string("{"), std::string("[]"), std::string("null"), std::string("{}"),
        std::string(4096, '['), std::string(R"({"kind":"stop"})"), std::string(R"({"kind":"command","line":"P1"})"),
        std::string(R"({"kind":"command","id":1.5,"line":"P1"})"),
        std::string(R"({"kind":"command","id":1,"line":""})"), std::string(R"({"kind":"command","id":-1,"line":"P1"})"),
        std::string(R"({"kind":"command","id":18446744073709551615,"line":"P1"})"),
        std::string(R"({"kind":"command","id":1,"line":"P1\rP2"})"),
        std::string(R"({"kind":"command","id":1,"line":"\u00e4"})"),
        R"({"kind":"command","id":1,"line":")" + std::string(256, 'P') + "\"}",
        std::string(R"({"kind":"watch","items":"X:$0"})"), std::string(R"({"kind":"watch","items":["X:$0 Y:$0"]})"),
        R"({"kind":"watch","items":[")" + std::string(101, 'x') + "\"]}"})
    EXPECT_THROW(parse_page_message(text), PageMistake) << text.substr(0, 60);
}

}  // namespace
}  // namespace brick
