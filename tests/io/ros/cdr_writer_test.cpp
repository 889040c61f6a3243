#include "radioslam/io/ros/cdr_writer.hpp"

#include <gtest/gtest.h>

#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {
namespace {

TEST(CdrWriter, AlignsNumbersBehindTheEncapsulation) {
  EXPECT_EQ(CdrWriter().u8(7).u32(1).take(), std::string("\0\1\0\0\7\0\0\0\1\0\0\0", 12));
  EXPECT_EQ(CdrWriter().u32(1).u64(2).take(), std::string("\0\1\0\0\1\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0", 20));
  EXPECT_EQ(CdrWriter().text("ab").u16(3).take(), std::string("\0\1\0\0\3\0\0\0ab\0\0\3\0", 14));
}

TEST(CdrWriter, IsReadAsItWasWritten) {
  const std::string bytes = CdrWriter()
                                .text("")
                                .u8(1)
                                .f64(-0.5)
                                .u16(65535)
                                .f32(1.5F)
                                .text("name")
                                .i32(-7)
                                .u64(~std::uint64_t{0})
                                .count(2)
                                .append("xy")
                                .take();
  const RosChannel channel{"/t", "T"};
  RosMessageReader in({channel, Stamp{0}, bytes, "test"});
  EXPECT_EQ(in.text(), "");
  EXPECT_EQ(in.u8(), 1);
  EXPECT_EQ(in.f64(), -0.5);
  EXPECT_EQ(in.u16(), 65535);
  EXPECT_EQ(in.f32(), 1.5F);
  EXPECT_EQ(in.text(), "name");
  EXPECT_EQ(in.i32(), -7);
  EXPECT_EQ(in.u64(), ~std::uint64_t{0});
  EXPECT_EQ(in.count(1), 2u);
  EXPECT_EQ(in.take(2), "xy");
  EXPECT_EQ(in.left(), 0u);
}

}  // namespace
}  // namespace radioslam
