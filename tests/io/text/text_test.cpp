#include "radioslam/io/text/text.hpp"

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"

namespace radioslam {
namespace {

std::vector<std::string> all_lines(const std::string& content) {
  const Text text = make_text("t", content);
  std::vector<std::string> result;
  for (TextLines lines(text); lines.next();) result.emplace_back(lines.line());
  return result;
}

TEST(Text, ReadsByteOrderMarkAndCrLfAsPlainText) {
  const std::vector<std::string> plain = {"a b", "", "c"};
  EXPECT_EQ(all_lines("a b\n\nc\n"), plain);
  EXPECT_EQ(all_lines("a b\r\n\r\nc\r\n"), plain);
  EXPECT_EQ(all_lines("\xef\xbb\xbf"
                      "a b\r\n\r\nc"),
            plain);
}

TEST(Text, CountsLinesFromOneOverCommentsAndBlanks) {
  const Text text = make_text("t", "# first\n\n  \t\nx\n  # indented\ny");
  TextLines lines(text);
  ASSERT_TRUE(lines.next_with_content());
  EXPECT_EQ(lines.number(), 4u);
  EXPECT_TRUE(lines.terminated());
  ASSERT_TRUE(lines.next_with_content());
  EXPECT_EQ(lines.number(), 6u);
  EXPECT_FALSE(lines.terminated());
  EXPECT_FALSE(lines.next_with_content());
}

TEST(Text, AcceptsUtf8) { EXPECT_EQ(all_lines("Sørensen €😀").front(), "Sørensen €😀"); }

TEST(Text, RefusesAnEmptyFile) {
  expect_refusal([] { make_text("t", ""); }, 1, "t:1: the file is empty");
  expect_refusal([] { make_text("t", "\xef\xbb\xbf"); }, 1, "empty");
}

TEST(Text, RefusesBytesThatAreNotText) {
  using std::string_literals::operator""s;
  for (const std::string& bad : {"\0"s, "\x01"s, "\xff"s, "\xc0\x80"s, "\xed\xa0\x80"s, "\xf4\x90\x80\x80"s,
                                 "\xe2\x82"s, "\x80"s, "\xf0\x80\x80\x80"s})
    expect_refusal([&] { make_text("t", "one\ntwo " + bad); }, 2,
                   bad == "\0"s || bad == "\x01"s ? "a control character" : "not UTF-8 text");
}

TEST(Text, OutputOfToolsMayBeUtf16OrHaveAnyBytes) {
  using std::string_literals::operator""s;
  EXPECT_EQ(make_tool_output("t",
                             "\xff\xfe"
                             "a\0\xe9\0\n\0\x3d\xd8\0\xde\x3d\xd8"s)
                .content,
            "a\xc3\xa9\n\xf0\x9f\x98\x80\xef\xbf\xbd");
  EXPECT_EQ(make_tool_output("t", "\xfe\xff\0a"s).content, "a");
  EXPECT_EQ(make_tool_output("t", "\x01\xff"s).content, "\x01\xff");
  expect_refusal(
      [] {
        make_text("t",
                  "\xff\xfe"
                  "a\0"s);
      },
      1, "not UTF-8 text");  // of mission files
}

TEST(Text, RefusesAMissingFileAndAFolder) {
  const TemporaryFolder folder;
  expect_refusal([&] { read_text(folder.path() / "none.txt"); }, 0, "no such file");
  expect_refusal([&] { read_text(folder.path()); }, 0, "is a folder");
}

TEST(Text, ReadsAFileOfAnySize) {
  const TemporaryFolder folder;
  const std::string content(3'000'001, 'x');
  EXPECT_EQ(read_text(folder.write("big.txt", content)).content, content);
}

}  // namespace
}  // namespace radioslam
