#include "experiments/results.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "supple/error.hpp"

namespace supple::experiments::table_test {

Table small_table() {
  Table table{"small", {"word", "count", "number_ms"}};
  table.add({std::string("a, \"b\""), std::uint64_t{1234567}, 0.1});
  table.add({std::string("<c>"), {}, 1234.5678});
  return table;
}

TEST(Table, CsvQuotesAndKeepsNumbersWhole) {
  EXPECT_EQ(csv_of(small_table()), "word,count,number_ms\n\"a, \"\"b\"\"\",1234567,0.1\n<c>,,1234.5678\n");
  EXPECT_EQ(csv_of(std::vector<Cell>{NAN, std::string()}), ",\n");
}

TEST(Table, RefusesARowOfAnotherWidth) {
  Table table = small_table();
  EXPECT_THROW(table.add({std::string("alone")}), Error);
}

}  // namespace supple::experiments::table_test
