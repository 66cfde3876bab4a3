// Text inside serialized messages, against protobuf's own parser and serializer.
#include <sstream>

#include <google/protobuf/util/delimited_message_util.h>
#include <gtest/gtest.h>

#include <dspace/Utf8.h>
#include <dspace/messages/WireText.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::testing {
namespace {

using session::WithTextUtf8;
using session::WithTextUtf8OfAll;

const auto& Type = *v1::Command::descriptor();

// Texts at several depths, in lists, beside numbers, arrays and bytes that are no text.
v1::Command Sample(const std::string& text) {
  v1::Command command;
  command.set_scene(text);
  v1::CreateMesh* create = command.mutable_create_mesh();
  create->mutable_object()->set_name("box " + text);
  create->mutable_object()->set_id(77);
  create->mutable_object()->mutable_offset()->mutable_position()->set_x(-1.5);
  v1::MeshData* mesh = create->add_level()->add_mesh();
  mesh->set_part(text);
  mesh->set_position(std::string("\xff\xfe\xe4\0", 4)); // bytes
  return command;
}

TEST(WireText, BecomesUtf8AndNothingElseChanges) {
  const std::string foreign = Sample("M\xE4st").SerializeAsString();
  const std::optional<std::string> readable = WithTextUtf8(foreign, Type);
  ASSERT_TRUE(readable);
  v1::Command parsed;
  ASSERT_TRUE(parsed.ParseFromString(*readable));
  EXPECT_EQ(parsed.SerializeAsString(), Sample("M\xC3\xA4st").SerializeAsString());
  EXPECT_EQ(parsed.create_mesh().level(0).mesh(0).position(), std::string("\xff\xfe\xe4\0", 4));
}

TEST(WireText, LengthsThatGrowAreWrittenAnew) {
  const std::string text(100, '\xE4'); // 100 bytes become 200, and their length two bytes
  const auto readable = WithTextUtf8(Sample(text).SerializeAsString(), Type);
  v1::Command parsed;
  ASSERT_TRUE(readable && parsed.ParseFromString(*readable));
  EXPECT_EQ(parsed.scene(), ToUtf8(text));
}

TEST(WireText, SoundTextIsLeftAlone) {
  for (const char* text : {"", "plain", "M\xC3\xA4st"}) {
    EXPECT_FALSE(WithTextUtf8(Sample(text).SerializeAsString(), Type));
  }
  EXPECT_FALSE(WithTextUtf8("", Type));
}

TEST(WireText, FieldsThatAreUnknownStay) {
  std::string bytes = Sample("M\xE4st").SerializeAsString();
  bytes += std::string("\xf2\xff\x07\x02\xe4\xe4", 6); // field 16382, of bytes
  bytes += std::string("\xf8\xff\x07\x05", 4);         // field 16383, a number
  const auto readable = WithTextUtf8(bytes, Type);
  v1::Command parsed;
  ASSERT_TRUE(readable && parsed.ParseFromString(*readable));
  EXPECT_EQ(parsed.GetReflection()->GetUnknownFields(parsed).field_count(), 2);
}

TEST(WireText, MalformedBytesAreNoMessage) {
  const std::string bytes = Sample("M\xE4st").SerializeAsString();
  int whole = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    whole += WithTextUtf8(bytes.substr(0, size), Type) ? 1 : 0; // cut between fields
  }
  EXPECT_LT(whole, 5);
  EXPECT_FALSE(WithTextUtf8("\x0a\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01", Type));
  EXPECT_FALSE(WithTextUtf8("\x0b\xe4", Type)); // a group
  EXPECT_FALSE(WithTextUtf8(std::string(20, '\xff'), Type));
}

TEST(WireText, OfMessagesAfterTheirLengths) {
  std::ostringstream foreign, expected;
  for (const char* text : {"a", "M\xE4st", "b"}) {
    google::protobuf::util::SerializeDelimitedToOstream(Sample(text), &foreign);
    google::protobuf::util::SerializeDelimitedToOstream(Sample(ToUtf8(text)), &expected);
  }
  EXPECT_EQ(WithTextUtf8OfAll(foreign.str(), Type).value_or("none"), expected.str());
  EXPECT_FALSE(WithTextUtf8OfAll(expected.str(), Type));
  EXPECT_FALSE(WithTextUtf8OfAll(foreign.str().substr(0, foreign.str().size() - 1), Type));
  EXPECT_FALSE(WithTextUtf8OfAll("", Type));
}

} // namespace
} // namespace dspace::testing
