#include "link/udp.h"

#include <gtest/gtest.h>

#include "expect_error.h"

namespace hapsim {
namespace {

TEST(UdpAddress, IsReadInEveryForm) {
  for (const auto& [text, told] :
       std::vector<std::pair<std::string, std::string>>{{"9000", "127.0.0.1:9000"},
                                                        {"127.0.0.1:0", "127.0.0.1:0"},
                                                        {"[::1]:9000", "[::1]:9000"},
                                                        {"[::]:7", "[::]:7"},
                                                        {"0.0.0.0:7", "0.0.0.0:7"},
                                                        {"localhost:80", "127.0.0.1:80"},
                                                        {"[::ffff:10.0.0.1]:5", "10.0.0.1:5"}})
    EXPECT_EQ(to_text(parse_address(text)), told);
  for (const char* text : {"", "host:", ":9", "1.2.3.4:70000", "::1:9000", "[::1", "a b:1.5"})
    EXPECT_NE(error_of([&] { parse_address(text); }, ExitCode::kUsage).find("not an address"),
              std::string::npos)
        << text;
  EXPECT_NE(error_of([] { parse_address("nowhere.invalid:9"); }, ExitCode::kIo).find("not found"),
            std::string::npos);
}

TEST(UdpAddress, KnowsThisMachine) {
  for (const char* text : {"9000", "127.1.2.3:9", "[::1]:9", "[::ffff:127.0.0.1]:9"})
    EXPECT_TRUE(parse_address(text).is_loopback()) << text;
  for (const char* text : {"0.0.0.0:9", "[::]:9", "128.0.0.1:9", "[fe80::1]:9", "[::2]:9"})
    EXPECT_FALSE(parse_address(text).is_loopback()) << text;
}

TEST(UdpSocket, CarriesOverIpv4AndIpv6) {
  for (const char* where : {"127.0.0.1:0", "[::1]:0"}) {
    UdpSocket there(parse_address(where)), here(any_port_towards(there.address()));
    const std::array<unsigned char, 3> text{1, 2, 3};
    here.send(there.address(), text);
    there.wait(std::numeric_limits<std::int64_t>::max() / 2);
    std::array<unsigned char, 8> got{};
    UdpAddress from;
    ASSERT_EQ(there.receive(got, from), 3u) << where;
    EXPECT_EQ(from, here.address());
    EXPECT_EQ(got[2], 3);
  }
}

}  // namespace
}  // namespace hapsim
