// What a server does with commands from anywhere: they are confined, carried out, kept by the
// ledger, and what the ledger says makes the state again. A fuzz target: input is a
// WatchReply.Snapshot, a list of commands. Nothing in it may crash, hang, throw, or end in an error
// of Dspace's own (INTERNAL).
//
// With clang and -DDSPACE_LIBFUZZER=ON it is libFuzzer's program; else it has a driver of its own,
// which changes messages field by field and byte by byte:
//   FuzzLink [--runs N] [--seconds S] [--seed N]   mutates (default: 2000 runs, at most 20 s, seed
//   1) FuzzLink FILE ...                              runs inputs, as libFuzzer leaves them
//   FuzzLink --corpus FOLDER                       writes one valid input a kind of command
// An input that fails is left in the working folder as "fuzz-link-failure".
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/session/Confinement.h>
#include <dspace/session/ErrorReply.h>
#include <dspace/session/Interpreter.h>
#include <dspace/session/Ledger.h>
#include <dspace/session/service.pb.h>

namespace {

using namespace dspace;
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

const Root& TheRoot() {
  static const Root root;
  return root;
}

// A failure of Dspace's, not of the input's.
[[noreturn]] void Fail(const std::string& what, const v1::Command& command) {
  std::fprintf(stderr, "%s\n%s\n", what.c_str(), command.DebugString().substr(0, 4000).c_str());
  std::abort();
}

v1::Reply Execute(session::Interpreter& interpreter, const session::Confinement& confinement,
                  v1::Command& command) {
  return session::Catch([&] {
    confinement.Apply(command);
    const FilesGuard guard([&](const std::string& path) { confinement.RequireWithin(path); });
    return interpreter.Execute(command);
  });
}

void RunCommands(Commands& commands) {
  static const session::Confinement confinement({TheRoot().Path});
  session::Interpreter interpreter;
  session::Ledger ledger;
  interpreter.AddListener(
      [&](const v1::Command& command, const v1::Reply& reply) { ledger.Add(command, reply); });
  for (v1::Command& command : *commands.mutable_command()) {
    const v1::Command before = command;
    const v1::Reply reply = Execute(interpreter, confinement, command);
    if (reply.error().kind() == v1::Error::INTERNAL && reply.has_error()) {
      Fail(reply.error().message(), before);
    }
  }
  session::Interpreter copy;
  for (v1::Command& command : ledger.Commands()) {
    const v1::Reply reply = Execute(copy, confinement, command);
    if (reply.has_error()) {
      Fail("of the ledger: " + reply.error().message(), command);
    }
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Commands commands;
  v1::DriveRequest request;
  (void)request.ParseFromArray(data, int(size));  // as it comes over the wire
  (void)commands.ParseFromArray(data, int(size)); // what could be read of it counts
  RunCommands(commands);
  return 0;
}

#ifndef DSPACE_LIBFUZZER
namespace {

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
    if (field.name() == "path" || field.name() == "texture" || field.name() == "folder") {
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
std::vector<Commands> Corpus(Mutator& mutator) {
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

void RunBytes(const std::string& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

int Fuzz(long runs, double seconds, unsigned seed) {
  Mutator mutator(seed);
  std::vector<Commands> corpus = Corpus(mutator);
  const auto began = std::chrono::steady_clock::now();
  long run = 0;
  for (; run < runs; ++run) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
    if (spent.count() > seconds) {
      break;
    }
    Commands commands = corpus[mutator.Below(unsigned(corpus.size()))];
    for (unsigned n = mutator.Below(4); n > 0; --n) { // what one kind makes, others meet
      const Commands& more = corpus[mutator.Below(unsigned(corpus.size()))];
      *commands.add_command() = more.command(more.command_size() - 1);
    }
    for (unsigned n = mutator.Below(6); n > 0; --n) {
      mutator.Change(
          *commands.mutable_command(int(mutator.Below(unsigned(commands.command_size())))));
    }
    std::string bytes = commands.SerializeAsString();
    if (run % 4 == 3) {
      bytes = mutator.Damage(std::move(bytes));
    }
    std::ofstream("fuzz-link-failure", std::ios::binary) << bytes;
    RunBytes(bytes);
    if (mutator.Below(20) == 0 && corpus.size() < 5000) {
      corpus.push_back(std::move(commands));
    }
  }
  std::filesystem::remove("fuzz-link-failure");
  std::printf("%ld inputs from seed %u, of %d kinds of commands; none failed\n", run, seed,
              v1::Command::descriptor()->field_count() - 1);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  long runs = 2000;
  double seconds = 20;
  unsigned seed = 1;
  const char* given = std::getenv("DSPACE_LONG");
  if (given && *given) {
    runs = 1000000;
    seconds = 300;
  }
  bool files = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (word == "--runs") {
      runs = std::atol(value);
    } else if (word == "--seconds") {
      seconds = std::atof(value);
    } else if (word == "--seed") {
      seed = unsigned(std::atol(value));
    } else if (word == "--corpus") {
      Mutator mutator(seed);
      int n = 0;
      for (const Commands& commands : Corpus(mutator)) {
        std::ofstream(std::string(value) + "/" + std::to_string(n++), std::ios::binary)
            << commands.SerializeAsString();
      }
      return 0;
    } else {
      std::ifstream in(word, std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      RunBytes(bytes.str());
      files = true;
      continue;
    }
    ++i;
  }
  return files ? 0 : Fuzz(runs, seconds, seed);
}
#endif
