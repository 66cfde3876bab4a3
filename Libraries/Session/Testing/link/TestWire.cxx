// What other versions and other languages rely on: numbers and types that never change (wire.lock),
// and a comment for everything.
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <google/protobuf/descriptor.pb.h>

#include <gtest/gtest.h>

#include <dspace/messages/CommandTraits.h>
#include <dspace/proto/service.pb.h>

namespace dspace::testing {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::SourceLocation;

// --- The wire ---------------------------------------------------------------------------------

// One for each field and each value of an enumeration: what must stay.
void Describe(const EnumDescriptor& type, std::set<std::string>& lines) {
  for (int i = 0; i < type.value_count(); ++i) {
    lines.insert(type.full_name() + " " + std::to_string(type.value(i)->number()) + " " +
                 type.value(i)->name());
  }
}

void Describe(const Descriptor& message, std::set<std::string>& lines) {
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    std::string type = field.message_type() ? field.message_type()->full_name()
                       : field.enum_type()  ? field.enum_type()->full_name()
                                            : field.type_name();
    if (field.is_repeated()) {
      type = "repeated " + type;
    } else if (field.real_containing_oneof()) {
      type = "oneof " + type;
    } else if (field.has_optional_keyword()) {
      type = "optional " + type;
    }
    lines.insert(message.full_name() + " " + std::to_string(field.number()) + " " + field.name() +
                 " " + type);
  }
  for (int i = 0; i < message.nested_type_count(); ++i) {
    Describe(*message.nested_type(i), lines);
  }
  for (int i = 0; i < message.enum_type_count(); ++i) {
    Describe(*message.enum_type(i), lines);
  }
}

// service.proto and all that it imports, which is all that goes over the wire: options do not.
void Files(const FileDescriptor& file, std::map<std::string, const FileDescriptor*>& files) {
  const bool isOptions = file.name().find("options.proto") != std::string::npos;
  if (!isOptions && files.emplace(file.name(), &file).second) {
    for (int i = 0; i < file.dependency_count(); ++i) {
      Files(*file.dependency(i), files);
    }
  }
}

TEST(Wire, NothingHasChangedOrGone) {
  std::map<std::string, const FileDescriptor*> files;
  Files(*v1::WatchReply::descriptor()->file(), files);
  std::set<std::string> present;
  for (const auto& [name, file] : files) {
    for (int i = 0; i < file->message_type_count(); ++i) {
      Describe(*file->message_type(i), present);
    }
    for (int i = 0; i < file->enum_type_count(); ++i) {
      Describe(*file->enum_type(i), present);
    }
  }
  std::ifstream lock(WIRE_LOCK);
  ASSERT_TRUE(lock) << "wire.lock is not there";
  std::set<std::string> locked;
  for (std::string line; std::getline(lock, line);) {
    if (!line.empty() && line[0] != '#') {
      EXPECT_TRUE(locked.insert(line).second) << "wire.lock has this line twice: " << line;
    }
  }
  EXPECT_GT(locked.size(), 1000u);
  for (const std::string& line : locked) {
    // Other programs were compiled with it. A field that is of no use any more stays.
    EXPECT_TRUE(present.count(line)) << "changed or removed, which must not be: " << line;
  }
  std::string added;
  for (const std::string& line : present) {
    added += locked.count(line) ? "" : line + "\n";
  }
  if (std::getenv("DSPACE_LOCK_WIRE")) { // what is new is to stay as it is
    std::ofstream(WIRE_LOCK, std::ios::app) << added;
    return;
  }
  EXPECT_EQ(added, "")
      << "new: once it is to stay as it is, run this test with DSPACE_LOCK_WIRE=1, "
         "which adds these lines to wire.lock, and raise "
         "COMMAND_SET_VERSION (service.proto) for the next release:\n"
      << added;
}

// --- Comments ---------------------------------------------------------------------------------

// A message has a comment of its own, unless it stands in another one. A field has one of its own;
// or follows one of the same type that has; or stands in backquotes in the comment of its message
// or at the head of its file; or is of a message or enumeration, which says what it is.
class Comments {
public:
  explicit Comments(const FileDescriptor& file) : File_(file) {
    SourceLocation location;
    if (file.GetSourceLocation({12}, &location)) { // `syntax`
      for (const std::string& each : location.leading_detached_comments) {
        this->Head_ += each;
      }
      this->Head_ += location.leading_comments;
    }
  }
  void Check(const Descriptor& message) {
    SourceLocation location;
    ASSERT_TRUE(message.GetSourceLocation(&location));
    const std::string own = location.leading_comments;
    if (own.empty() && !message.containing_type()) {
      ADD_FAILURE() << this->File_.name() << ": message " << message.full_name()
                    << " has no comment";
    }
    ++this->Messages;
    const FieldDescriptor* before = nullptr;
    bool said = false;
    for (int i = 0; i < message.field_count(); ++i) {
      const FieldDescriptor& field = *message.field(i);
      ASSERT_TRUE(field.GetSourceLocation(&location));
      const std::string quoted = "`" + field.name() + "`";
      const bool follows =
          said && before->type() == field.type() && before->is_repeated() == field.is_repeated();
      said = !location.leading_comments.empty() || !location.trailing_comments.empty() || follows ||
             own.find(quoted) != std::string::npos ||
             this->Head_.find(quoted) != std::string::npos || field.message_type() ||
             field.enum_type();
      EXPECT_TRUE(said) << this->File_.name() << ": field " << field.full_name()
                        << " has no comment";
      before = &field;
      ++this->Fields;
    }
    for (int i = 0; i < message.nested_type_count(); ++i) {
      this->Check(*message.nested_type(i));
    }
  }
  int Messages = 0;
  int Fields = 0;

private:
  const FileDescriptor& File_;
  std::string Head_;
};

TEST(Wire, EverythingHasAComment) {
  // The .proto files as protoc reads them, with their comments, imported ones first.
  google::protobuf::FileDescriptorSet set;
  std::ifstream file(WIRE_COMMENTS, std::ios::binary);
  ASSERT_TRUE(set.ParseFromIstream(&file)) << WIRE_COMMENTS;
  google::protobuf::DescriptorPool pool;
  for (const google::protobuf::FileDescriptorProto& each : set.file()) {
    ASSERT_TRUE(pool.BuildFile(each)) << each.name();
  }
  const FileDescriptor* service = pool.FindFileByName("dspace/proto/service.proto");
  ASSERT_TRUE(service);
  std::map<std::string, const FileDescriptor*> files;
  Files(*service, files);
  int messages = 0;
  int fields = 0;
  for (const auto& [name, each] : files) {
    Comments comments(*each);
    for (int i = 0; i < each->message_type_count(); ++i) {
      comments.Check(*each->message_type(i));
    }
    messages += comments.Messages;
    fields += comments.Fields;
  }
  EXPECT_GT(messages, 200);
  EXPECT_GT(fields, 1000);
}

} // namespace
} // namespace dspace::testing
