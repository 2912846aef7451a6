// A memo holds no more bytes than it may, and what is gone is made again.
#include "base/memo.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/random.h"

namespace hapsim {
namespace {

struct Block {
  Block(int its_number, std::size_t size) : number(its_number), bytes(size) {}
  int number;
  std::vector<char> bytes;
  std::size_t held_bytes() const { return hapsim::held_bytes(bytes); }
};

TEST(HeldBytes, AreTheHeapsOfAllParts) {
  EXPECT_EQ(held_bytes(3.0), 0u);
  EXPECT_EQ(held_bytes(Eigen::Matrix3d()), 0u);
  EXPECT_EQ(held_bytes(std::string("short")), 0u);
  EXPECT_GE(held_bytes(std::string(100, 'x')), 100u);
  EXPECT_EQ(held_bytes(Eigen::MatrixXd(5, 7)), 35 * sizeof(double));
  EXPECT_EQ(held_bytes(Eigen::Matrix<float, 6, Eigen::Dynamic>(6, 4)), 24 * sizeof(float));
  std::vector<Eigen::Matrix3d> matrices;
  matrices.reserve(10);
  EXPECT_EQ(held_bytes(matrices), 10 * sizeof(Eigen::Matrix3d));
  const std::vector<std::vector<double>> rows{std::vector<double>(3), std::vector<double>(4)};
  EXPECT_EQ(held_bytes(rows), 2 * sizeof(std::vector<double>) + 7 * sizeof(double));
  const auto block = std::make_shared<Block>(1, 50);
  EXPECT_EQ(held_bytes(block), sizeof(Block) + 50);
  EXPECT_EQ(held_bytes(std::vector{block, block}), 2 * (sizeof block + sizeof(Block) + 50));
  EXPECT_EQ(held_bytes(std::shared_ptr<Block>()), 0u);
}

TEST(Memo, LetsTheOldestGo) {
  Memo memo(3500);
  for (int k = 0; k < 3; ++k) memo.put(std::to_string(k), std::make_shared<Block>(k, 900));
  EXPECT_GT(memo.bytes(), 2700u);
  ASSERT_NE(memo.find<Block>("0"), nullptr);
  memo.put("3", std::make_shared<Block>(3, 900));
  EXPECT_EQ(memo.find<Block>("1"), nullptr) << "not asked for longest";
  EXPECT_EQ(memo.find<Block>("0")->number, 0);
  EXPECT_EQ(memo.find<Block>("3")->number, 3);
  EXPECT_LE(memo.bytes(), memo.budget());
  memo.put("large", std::make_shared<Block>(4, 2500));
  EXPECT_EQ(memo.find<Block>("0"), nullptr);
  EXPECT_EQ(memo.find<Block>("large")->number, 4);
  memo.put("larger than all", std::make_shared<Block>(5, 4000));
  EXPECT_EQ(memo.find<Block>("larger than all"), nullptr);
  EXPECT_NE(memo.find<Block>("large"), nullptr) << "made no room for what has none anyway";
}

TEST(Memo, CountsAgainWhatHasGrown) {
  Memo memo(3500);
  memo.put("a", std::make_shared<Block>(0, 100));
  const std::size_t before = memo.bytes();
  auto block = memo.take<Block>("a");
  EXPECT_EQ(memo.bytes(), 0u);
  EXPECT_EQ(memo.find<Block>("a"), nullptr);
  block->bytes = std::vector<char>(1100);
  memo.put("a", block);
  EXPECT_EQ(memo.bytes(), before + 1000);
  memo.put("a", std::make_shared<Block>(1, 100));
  EXPECT_EQ(memo.bytes(), before);
  EXPECT_EQ(memo.find<Block>("a")->number, 1);
}

TEST(Memo, KeepsTypesApart) {
  Memo memo;
  memo.put("a", std::make_shared<const double>(2.5));
  memo.put("a", std::make_shared<Block>(7, 1));
  EXPECT_EQ(*memo.find<double>("a"), 2.5);
  EXPECT_EQ(memo.find<Block>("a")->number, 7);
  EXPECT_EQ(memo.find<int>("a"), nullptr);
}

TEST(Memo, SendsNobodyAwayWhereItIsAskedSo) {
  Memo memo(2500);
  for (int round = 0; round < 2; ++round)
    for (int k = 0; k < 4; ++k) {
      const std::string key = std::to_string(k);
      auto block = memo.take<Block>(key);
      EXPECT_EQ(block != nullptr, round == 1 && k < 2) << k;
      memo.put_if_room(key, std::make_shared<Block>(k, 900));
    }
}

TEST(Memo, KeepsNothingOfNoBudget) {
  Memo memo(0);
  memo.put("a", std::make_shared<const int>(1));
  memo.put_if_room("b", std::make_shared<const int>(1));
  EXPECT_EQ(memo.find<int>("a"), nullptr);
  EXPECT_EQ(memo.take<int>("b"), nullptr);
  EXPECT_EQ(memo.bytes(), 0u);
}

// Whatever the budget, its use is the sum of what is there, and what is there is right.
TEST(Memo, IsNeverAboveItsBudget) {
  for (const std::size_t budget : {0u, 500u, 5000u, 50000u}) {
    Memo memo(budget);
    Random random(1);
    for (int k = 0; k < 3000; ++k) {
      const int number = static_cast<int>(random.uniform() * 40);
      const std::string key = std::to_string(number);
      const auto found = memo.find<Block>(key);
      EXPECT_TRUE(!found || found->number == number);
      const auto size = static_cast<std::size_t>(random.uniform() * 1500);
      memo.put(key, std::make_shared<Block>(number, size));
      ASSERT_LE(memo.bytes(), budget);
    }
    for (int k = 0; k < 40; ++k) memo.take<Block>(std::to_string(k));
    EXPECT_EQ(memo.bytes(), 0u);
  }
}

}  // namespace
}  // namespace hapsim
