#include "experiments/report.hpp"

#include <gtest/gtest.h>

#include "supple/error.hpp"

namespace supple::experiments::report_test {

Table small_table() {
  Table table{"small", "A table", {{"word", "Word"}, {"count", "Count"}, {"number_ms", "Number ms", 3}}};
  table.add({std::string("a, \"b\""), std::uint64_t{1234567}, 0.1});
  table.add({std::string("<c>"), {}, 1234.5678});
  return table;
}

TEST(Table, CsvQuotesAndKeepsNumbersWhole) {
  EXPECT_EQ(csv_of(small_table()), "word,count,number_ms\n\"a, \"\"b\"\"\",1234567,0.1\n<c>,,1234.5678\n");
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

TEST(Table, TextIsAligned) {
  EXPECT_EQ(text_of(small_table()),
            "A table\n"
            "  Word        Count  Number ms\n"
            "  a, \"b\"  1,234,567      0.100\n"
            "  <c>             –       1235\n");
}

TEST(Table, RefusesARowOfAnotherWidth) {
  Table table = small_table();
  EXPECT_THROW(table.add({std::string("alone")}), Error);
}

TEST(Rounded, HasSignificantDigits) {
  EXPECT_EQ(rounded(0), "0");
  EXPECT_EQ(rounded(0.0012345), "0.00123");
  EXPECT_EQ(rounded(12.345), "12.3");
  EXPECT_EQ(rounded(1234.5), "1234");
  EXPECT_EQ(rounded(99.99), "100");
  EXPECT_EQ(rounded(-2.5, 2), "-2.5");
  EXPECT_EQ(rounded(1e-9), "1.00e-09");
  EXPECT_EQ(rounded(1.0 / 0.0), "∞");
}

TEST(Report, SaysWhatHolds) {
  Report report;
  report.title = "Title";
  report.claims = {{"first", "7", "one", Verdict::holds, "because"},
                   {"second", "5, 6", "two", Verdict::does_not_hold, "for"},
                   {"third", "", "three", Verdict::cannot_tell, "as"}};
  report.sections.push_back({"Section", {"Paragraph"}, {small_table()}});
  const std::string text = text_of(report);
  EXPECT_NE(text.find("- one (section 7)\n  Holds. because\n- two (section 5, 6)\n  Does not hold. for\n- "
                      "three\n  Undecided. as\n"),
            std::string::npos);
}

}  // namespace supple::experiments::report_test
