#include "experiments/table.hpp"

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

TEST(Table, CsvIsReadBack) {
  const CsvText csv = parse_csv(csv_of(small_table()) + "torn,\"off");
  EXPECT_EQ(csv.rows,
            (std::vector<std::vector<std::string>>{
                {"word", "count", "number_ms"}, {"a, \"b\"", "1234567", "0.1"}, {"<c>", "", "1234.5678"}}));
  EXPECT_EQ(csv.length, csv_of(small_table()).size());
  EXPECT_EQ(parse_csv("\"\",\"\"\"\",\"a\nb\"\n").rows,
            (std::vector<std::vector<std::string>>{{"", "\"", "a\nb"}}));
  EXPECT_TRUE(parse_csv("").rows.empty());
  const std::string commented = "# a: b,\"c\n#\nx\n" + csv_of(std::vector<Cell>{std::string("#1")});
  EXPECT_EQ(parse_csv(commented + "# torn").rows, (std::vector<std::vector<std::string>>{{"x"}, {"#1"}}));
  EXPECT_EQ(parse_csv(commented + "# torn").length, commented.size());
}

TEST(Table, RefusesARowOfAnotherWidth) {
  Table table = small_table();
  EXPECT_THROW(table.add({std::string("alone")}), Error);
}

}  // namespace supple::experiments::table_test
