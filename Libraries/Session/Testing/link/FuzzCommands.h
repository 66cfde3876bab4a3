// Commands as a fuzz target takes them: made and changed by chance.
#ifndef DSPACE_FUZZ_COMMANDS_H
#define DSPACE_FUZZ_COMMANDS_H

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <dspace/proto/service.pb.h>

namespace dspace::testing {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using Commands = v1::WatchReply::Snapshot;

// The folder that commands may read; goes with the process.
class Root {
public:
  Root() {
    char name[] = "/tmp/dspace-fuzz-XXXXXX";
    this->Path = mkdtemp(name);
    std::ofstream(this->Path + "/grid.asc")
        << "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n7 8 9\n";
    std::ofstream(this->Path + "/part.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  }
  ~Root() { std::filesystem::remove_all(this->Path); }
  std::string Path;
};

inline const Root& TheRoot() {
  static const Root root;
  return root;
}

class Mutator {
public:
  explicit Mutator(unsigned seed) : Random_(seed) {}

  unsigned Below(unsigned n) { return unsigned(this->Random_() % n); }

  // Fields of all kinds with values that often mean something.
  void Fill(Message& message, int depth) {
    const auto* descriptor = message.GetDescriptor();
    for (int i = 0; i < descriptor->field_count(); ++i) {
      if (!descriptor->field(i)->containing_oneof() && this->Below(2) == 0) {
        this->Set(message, *descriptor->field(i), depth);
      }
    }
    for (int i = 0; i < descriptor->oneof_decl_count(); ++i) {
      const auto* oneof = descriptor->oneof_decl(i);
      this->Set(message, *oneof->field(int(this->Below(unsigned(oneof->field_count())))), depth);
    }
  }

  void Set(Message& message, const FieldDescriptor& field, int depth) {
    if (depth > 6) {
      return;
    }
    const auto* reflection = message.GetReflection();
    const unsigned n = field.is_repeated() ? this->Below(4) : 1;
    for (unsigned i = 0; i < n; ++i) {
      this->Put(message, *reflection, field, depth);
    }
  }

  // One change, somewhere below.
  void Change(Message& message, int depth = 0) {
    const auto* descriptor = message.GetDescriptor();
    if (descriptor->field_count() == 0) {
      return;
    }
    const auto* reflection = message.GetReflection();
    std::vector<const FieldDescriptor*> there;
    reflection->ListFields(message, &there);
    const bool other = there.empty() || this->Below(4) == 0;
    const FieldDescriptor& field =
        other ? *descriptor->field(int(this->Below(unsigned(descriptor->field_count()))))
              : *there[this->Below(unsigned(there.size()))];
    if (field.message_type() && !other && depth < 6) {
      if (!field.is_repeated()) {
        return this->Change(*reflection->MutableMessage(&message, &field), depth + 1);
      }
      const int n = reflection->FieldSize(message, &field);
      return this->Change(
          *reflection->MutableRepeatedMessage(&message, &field, int(this->Below(unsigned(n)))),
          depth + 1);
    }
    if (this->Below(3) == 0) {
      reflection->ClearField(&message, &field);
    }
    this->Set(message, field, depth);
  }

  std::string Damage(std::string bytes) {
    for (unsigned n = 1 + this->Below(4); n > 0 && !bytes.empty(); --n) {
      const std::size_t at = this->Random_() % bytes.size();
      switch (this->Below(3)) {
      case 0:
        bytes[at] = char(this->Random_());
        break;
      case 1:
        bytes.erase(at, 1 + this->Below(8));
        break;
      default:
        bytes.insert(at, 1 + this->Below(8), char(this->Random_()));
      }
    }
    return bytes;
  }

private:
  double Number() {
    const double numbers[] = {0, 1, -1, 0.5, 2, 3, 1e-300, 1e300, -0.0, HUGE_VAL, NAN, 1e18, 100};
    return this->Below(3) == 0 ? numbers[this->Below(13)] : double(this->Below(5));
  }
  std::uint64_t Integer() {
    const std::uint64_t numbers[] = {std::uint64_t(-1), 1u << 31, 1000000, 0x7fffffff};
    return this->Below(8) == 0 ? numbers[this->Below(4)] : this->Below(6);
  }
  std::string Text(const FieldDescriptor& field) {
    const v1::TextOptions::Kind kind = field.options().GetExtension(v1::holds);
    if (kind == v1::TextOptions::READ_FILE || kind == v1::TextOptions::NEW_FILE) {
      const char* names[] = {"/grid.asc", "/part.obj", "/nothing", "", "/../x", "/out.json"};
      return TheRoot().Path + names[this->Below(6)];
    }
    const char* texts[] = {"",    "scene",     "main",     "physical", "a",
                           "sun", "EPSG:4326", "\xc3\xa9", "\n"};
    return texts[this->Below(9)];
  }

  void Put(Message& m, const google::protobuf::Reflection& r, const FieldDescriptor& f, int depth) {
    const bool many = f.is_repeated();
    switch (f.cpp_type()) {
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return this->Fill(many ? *r.AddMessage(&m, &f) : *r.MutableMessage(&m, &f), depth + 1);
    case FieldDescriptor::CPPTYPE_STRING:
      return many ? r.AddString(&m, &f, this->Text(f)) : r.SetString(&m, &f, this->Text(f));
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return many ? r.AddDouble(&m, &f, this->Number()) : r.SetDouble(&m, &f, this->Number());
    case FieldDescriptor::CPPTYPE_FLOAT:
      return many ? r.AddFloat(&m, &f, float(this->Number()))
                  : r.SetFloat(&m, &f, float(this->Number()));
    case FieldDescriptor::CPPTYPE_BOOL:
      return many ? r.AddBool(&m, &f, this->Below(2) == 0) : r.SetBool(&m, &f, this->Below(2) == 0);
    case FieldDescriptor::CPPTYPE_ENUM:
      return many ? r.AddEnumValue(&m, &f, int(this->Below(6)))
                  : r.SetEnumValue(&m, &f, int(this->Below(6)));
    case FieldDescriptor::CPPTYPE_INT32:
      return many ? r.AddInt32(&m, &f, int(this->Integer()))
                  : r.SetInt32(&m, &f, int(this->Integer()));
    case FieldDescriptor::CPPTYPE_INT64:
      return many ? r.AddInt64(&m, &f, std::int64_t(this->Integer()))
                  : r.SetInt64(&m, &f, std::int64_t(this->Integer()));
    case FieldDescriptor::CPPTYPE_UINT32:
      return many ? r.AddUInt32(&m, &f, unsigned(this->Integer()))
                  : r.SetUInt32(&m, &f, unsigned(this->Integer()));
    case FieldDescriptor::CPPTYPE_UINT64:
      return many ? r.AddUInt64(&m, &f, this->Integer()) : r.SetUInt64(&m, &f, this->Integer());
    }
  }

  std::mt19937_64 Random_;
};

// A scene and a few frames, and one command of each kind after them.
inline std::vector<Commands> Corpus(Mutator& mutator) {
  std::vector<Commands> corpus;
  const auto* descriptor = v1::Command::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (!field.containing_oneof()) {
      continue;
    }
    Commands commands;
    commands.add_command()->mutable_create_scene();
    for (std::uint64_t id = 2; id < 5; ++id) {
      v1::CreateFrame* frame = commands.add_command()->mutable_create_frame();
      frame->set_id(id);
      frame->set_name("f" + std::to_string(id));
      frame->set_parent(id - 1);
    }
    mutator.Set(*commands.add_command(), field, 0);
    corpus.push_back(std::move(commands));
  }
  return corpus;
}

} // namespace dspace::testing

#endif
