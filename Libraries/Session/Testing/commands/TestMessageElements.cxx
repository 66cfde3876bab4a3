// The elements of messages, counted before they are parsed.
#include <dspace/messages/MessageElements.h>

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <dspace/Budgets.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/proto/objects.pb.h>

namespace dspace::session {
namespace {

std::uint64_t Count(const std::string& bytes, std::uint64_t most = 1000000) {
  google::protobuf::io::ArrayInputStream in(bytes.data(), static_cast<int>(bytes.size()));
  return CountElements(in, *v1::Command::descriptor(), most);
}

class ElementsForNow {
public:
  explicit ElementsForNow(std::uint64_t value) { SetBudget("message_elements", value); }
  ~ElementsForNow() {
    const BudgetInfo& info = Budgets()[static_cast<std::size_t>(Budget::MessageElements)];
    SetBudget(info.name, info.standard);
  }
  ElementsForNow(const ElementsForNow&) = delete;
  ElementsForNow& operator=(const ElementsForNow&) = delete;
};

// A CreateMesh of empty levels, which are two bytes each.
v1::Command EmptyLevels(int count) {
  v1::Command command;
  for (int i = 0; i < count; ++i) {
    command.mutable_create_mesh()->add_level();
  }
  return command;
}

TEST(MessageElements, AreFieldsItemsAndMessages) {
  EXPECT_EQ(Count(""), 0u);
  v1::Command command;
  command.set_scene("a");
  EXPECT_EQ(Count(command.SerializeAsString()), 1u);
  command = EmptyLevels(100);
  EXPECT_EQ(Count(command.SerializeAsString()), 101u); // the command itself is one
  for (auto& level : *command.mutable_create_mesh()->mutable_level()) {
    level.add_mesh();
    level.add_mesh()->set_digest("m");
  }
  EXPECT_EQ(Count(command.SerializeAsString()), 401u);
}

TEST(MessageElements, TakePackedNumbersAsOne) {
  v1::Command command;
  for (int i = 0; i < 1000; ++i) {
    command.mutable_set_poses()->add_frame(7);
    command.mutable_set_poses()->add_pose(1.0);
  }
  EXPECT_EQ(Count(command.SerializeAsString()), 3u);
}

TEST(MessageElements, CountFieldsThatNobodyKnows) {
  std::string bytes;
  for (int i = 0; i < 50; ++i) {
    bytes += std::string("\xf8\xff\x7f\x01", 4); // field 262143, the number 1
  }
  EXPECT_EQ(Count(bytes), 50u);
}

TEST(MessageElements, StopAfterTheLimit) {
  EXPECT_EQ(Count(EmptyLevels(100).SerializeAsString(), 10), 11u);
}

TEST(MessageElements, AreCountedAsFarAsBytesAreAMessage) {
  const std::string bytes = EmptyLevels(100).SerializeAsString();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_LE(Count(bytes.substr(0, size)), 101u);
  }
  EXPECT_LE(Count(std::string(100, '\xff')), 100u);
  std::string groups; // deeper than any parser follows
  for (int i = 0; i < 100000; ++i) {
    groups += "\xfb\xff\x7f";
  }
  EXPECT_LE(Count(groups), 200u);
}

TEST(MessageElements, AreLimited) {
  const std::string bytes = EmptyLevels(100).SerializeAsString();
  const v1::Command command;
  EXPECT_EQ(TooManyElements(bytes, *command.GetDescriptor()), "");
  {
    const ElementsForNow limit(101);
    EXPECT_EQ(TooManyElements(bytes, *command.GetDescriptor()), "");
  }
  const ElementsForNow limit(100);
  EXPECT_EQ(TooManyElements(bytes, *command.GetDescriptor()),
            "its " + std::to_string(bytes.size()) +
                " bytes have too many elements; the limit message_elements is 100, which "
                "dspace.limits.set raises");
}

} // namespace
} // namespace dspace::session
