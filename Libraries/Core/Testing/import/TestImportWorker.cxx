// Models and images that another process reads: the same result as here, and every end of that
// process as an error that names the file. FaultyWorker fails on demand.
#include "ImportTestSupport.h"
#include "Sanitized.h"

#include <dspace/Budgets.h>
#include <dspace/FileText.h>
#include <dspace/FilesRead.h>
#include <dspace/confine/FileRules.h>
#include <dspace/import/files/ImageReader.h>
#include <dspace/import/worker/Bytes.h>
#include <dspace/import/worker/ImportWorker.h>
#include <dspace/import/worker/ModelBytes.h>
#include <dspace/import/worker/ModelImport.h>
#include <dspace/import/worker/UrdfBytes.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include <sys/wait.h>
#include <zlib.h>

namespace dspace {
namespace {

using testing::ExpectError;

constexpr const char* Triangle =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid a\n";

std::string Bytes(const Model& model) {
  ByteWriter into;
  WriteModel(model, into);
  return into.Text();
}

std::string SeedPath(const std::string& name) {
  return std::string(DSPACE_SEEDS) + "/" + name;
}

class SetForNow {
public:
  SetForNow(Budget budget, std::uint64_t value)
      : Info_(Budgets()[static_cast<std::size_t>(budget)]) {
    SetBudget(this->Info_.name, value);
  }
  ~SetForNow() { SetBudget(this->Info_.name, this->Info_.standard); }
  SetForNow(const SetForNow&) = delete;
  SetForNow& operator=(const SetForNow&) = delete;

private:
  const BudgetInfo& Info_;
};

class Faulty : public ::testing::Test {
protected:
  std::string File(const std::string& name) const { return this->Folder_.Write(name, Triangle); }
  // The fault becomes an error that names the file; the next document is read as ever.
  void ExpectFault(const std::string& name, Error::Kind kind, const std::string& part) {
    const std::string path = this->File(name);
    ExpectError(kind, part, [&] { this->Worker_.ReadModel(path); });
    ExpectError(kind, "file '" + path + "'", [&] { this->Worker_.ReadModel(path); });
    EXPECT_EQ(this->Worker_.ReadModel(this->File("good.stl")).TriangleCount(), 1u);
  }

  testing::TempFolder Folder_;
  ImportWorker Worker_{FAULTY_WORKER};
};

TEST(ImportWorker, GivesTheModelThatIsReadHere) {
  for (const char* name :
       {"vrml2.wrl", "vrml1.wrl", "text.stl", "text.ply", "part.obj", "part.gltf"}) {
    const Model here = ReadModel(SeedPath(name));
    const Model there = ImportWorker::OfProcess().ReadModel(SeedPath(name));
    EXPECT_GT(here.meshes.size(), 0u);
    EXPECT_EQ(Bytes(there), Bytes(here)) << name;
    EXPECT_EQ(there.path, here.path);
  }
}

TEST(ImportWorker, GivesTheRobotThatIsReadHere) {
  const auto bytes = [](const Urdf& urdf) {
    ByteWriter into;
    WriteUrdf(urdf, into);
    return into.Text();
  };
  const Urdf here = ReadUrdf(SeedPath("arm.urdf"));
  const Urdf there = ImportWorker::OfProcess().ReadUrdf(SeedPath("arm.urdf"));
  EXPECT_GT(here.joints.size(), 0u);
  EXPECT_EQ(bytes(there), bytes(here));
  EXPECT_EQ(there.path, here.path);
  const std::uint64_t before = ImportWorker::OfProcess().Documents();
  const FilesGuard guard([](const std::string&) {});
  EXPECT_EQ(bytes(ImportUrdf(SeedPath("arm.urdf"))), bytes(here));
  EXPECT_EQ(ImportWorker::OfProcess().Documents(), before + 1);
}

TEST(ImportWorker, GivesTheErrorThatReadingHereGives) {
  const testing::TempFolder folder;
  for (const std::string& path :
       {folder / "absent.stl", folder.Write("empty.stl", ""), folder.Write("a.stl", "solid\nfacet"),
        folder.Write("b.wrl", "#VRML V2.0 utf8\nShape {"), folder.Write("c.txt", "hello")}) {
    std::string here, there;
    Error::Kind kind = Error::Kind::Internal;
    try {
      ReadModel(path);
    } catch (const Error& error) {
      here = error.what();
      kind = error.GetKind();
    }
    try {
      ImportWorker::OfProcess().ReadModel(path);
    } catch (const Error& error) {
      there = error.what();
      EXPECT_EQ(error.GetKind(), kind) << there;
      EXPECT_EQ(error.GetObjectName(), "file '" + path + "'");
    }
    EXPECT_NE(here, "") << path;
    EXPECT_EQ(there, here);
  }
}

TEST(ImportWorker, NotesAndChecksFilesInTheCallersThread) {
  const FilesReadScope scope;
  ImportWorker::OfProcess().ReadModel(SeedPath("part.gltf"));
  EXPECT_EQ(scope.Files().count(SeedPath("part.gltf")), 1u);
  EXPECT_EQ(scope.Files().count(SeedPath("part.bin")), 1u);
  const FilesGuard guard([](const std::string& path) {
    if (path.find("part.bin") != std::string::npos) {
      throw Error(Error::Kind::InvalidArgument, "file '" + path + "'", "is outside");
    }
  });
  ExpectError(Error::Kind::InvalidArgument, "is outside",
              [] { ImportWorker::OfProcess().ReadModel(SeedPath("part.gltf")); });
}

TEST(ImportWorker, NotesFilesWhoseTextIsOfAnotherEncoding) {
  const testing::TempFolder folder;
  const std::string path = folder.Write("latin.wrl", "#VRML V2.0 utf8\nDEF R\xfc"
                                                     "ck Shape { geometry Box { } }\n");
  const ForeignTextScope here;
  ReadModel(path);
  const ForeignTextScope there;
  ImportWorker::OfProcess().ReadModel(path);
  EXPECT_EQ(here.Objects().size(), 1u);
  EXPECT_EQ(there.Objects(), here.Objects());
}

TEST(ImportWorker, ReadsVrmlApartAndOthersHere) {
  const std::uint64_t before = ImportWorker::OfProcess().Documents();
  ImportModel(SeedPath("text.stl"));
  EXPECT_EQ(ImportWorker::OfProcess().Documents(), before);
  ImportModel(SeedPath("vrml2.wrl"));
  EXPECT_EQ(ImportWorker::OfProcess().Documents(), before + 1);
}

TEST(ImportWorker, ReadsEverythingApartUnderAGuard) {
  const FilesGuard guard([](const std::string&) {});
  const std::uint64_t before = ImportWorker::OfProcess().Documents();
  ImportModel(SeedPath("text.stl"));
  EXPECT_EQ(ImportWorker::OfProcess().Documents(), before + 1);
}

TEST(ImportWorker, ReadsEverythingApartWhenAsked) {
  SetImportsApart(true);
  const std::uint64_t before = ImportWorker::OfProcess().Documents();
  ImportModel(SeedPath("text.stl"));
  EXPECT_EQ(ImportWorker::OfProcess().Documents(), before + 1);
  SetImportsApart(false);
}

// Coin ends the process at a node that a field has replaced and that is used again, if it is given
// the text.
TEST(ImportWorker, GivesAnErrorForAFieldOfNodesThatIsGivenTwice) {
  const testing::TempFolder folder;
  const std::string path = folder.Write(
      "twice.wrl", "#VRML V2.0 utf8\nShape { geometry DEF B Box { } geometry Sphere { } }\n"
                   "Shape { geometry USE B }\n");
  ExpectError(Error::Kind::Corrupt, "file '" + path + "'", [&] { ImportModel(path); });
  EXPECT_EQ(ImportModel(SeedPath("vrml2.wrl")).path, SeedPath("vrml2.wrl"));
}

TEST_F(Faulty, SignalIsAnError) {
  this->ExpectFault("abort.stl", Error::Kind::Corrupt,
                    "the process that reads it ended by signal 6 (Aborted)");
}

TEST_F(Faulty, ExitIsAnError) {
  this->ExpectFault("exit.stl", Error::Kind::Corrupt,
                    "the process that reads it ended with status 3");
}

TEST_F(Faulty, MessageThatIsNoneIsAnError) {
  this->ExpectFault("liar.stl", Error::Kind::Internal,
                    "the process that reads it gave no valid result");
}

TEST_F(Faulty, MemoryLimitIsAnErrorThatNamesIt) {
  if (testing::Sanitized()) {
    GTEST_SKIP() << "the address sanitizer's memory cannot be limited";
  }
  const SetForNow memory(Budget::ImportMemory, std::uint64_t(64) << 20);
  this->ExpectFault("memory.stl", Error::Kind::Resource,
                    "reading it needs too much memory; the limit import_memory is 67108864");
}

TEST_F(Faulty, ClockIsALimit) {
  const SetForNow seconds(Budget::ImportSeconds, 1);
  this->ExpectFault("sleep.stl", Error::Kind::Resource,
                    "it took too long to read; the limit import_seconds is 1");
}

TEST_F(Faulty, ProcessorIsALimit) {
  const SetForNow seconds(Budget::ImportSeconds, 1);
  this->ExpectFault("spin.stl", Error::Kind::Resource,
                    "it took too long to read; the limit import_seconds is 1");
}

TEST_F(Faulty, ResultIsCheckedHere) {
  this->ExpectFault("indices.stl", Error::Kind::Corrupt, "index 1000000");
}

TEST_F(Faulty, ChildAsksForEveryFile) {
  const std::string path = this->File("outside.stl");
  const FilesGuard guard([](const std::string& file) {
    if (file.find("/etc/") == 0) {
      throw Error(Error::Kind::InvalidArgument, "file '" + file + "'", "is outside");
    }
  });
  ExpectError(Error::Kind::InvalidArgument, "file '/etc/hostname': is outside",
              [&] { this->Worker_.ReadModel(path); });
}

// What a hostile document can do, by the names of FaultyWorker's attempts, without any restriction
// and in the child.
constexpr const char* Possible =
    "read, list, process, write, create, creat, folder, link, rename, truncate, rights, rights of "
    "a "
    "descriptor, remove, socket of the network, socket of messages, socket of a path, pair of "
    "sockets, start a program, become a program, fork, trace, signal, signal to a thread, limits, "
    "outlive, thread";

TEST_F(Faulty, ChildCanDoNothingElse) {
  if (confine::FileRules::KernelAbi() < 1) {
    GTEST_SKIP() << "this kernel has no Landlock";
  }
  const std::string path = this->File("hostile.stl");
  const std::string beside = this->Folder_.Write("beside", "text");
  ExpectError(Error::Kind::Corrupt, "attempts: thread", [&] { this->Worker_.ReadModel(path); });
  EXPECT_EQ(std::filesystem::file_size(beside), 4u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(this->Folder_ / "."), {}), 2);
}

TEST_F(Faulty, ChildWithoutLandlockCanOnlyRead) {
  const std::string path = this->File("hostile.stl");
  this->Folder_.Write("beside", "text");
  ASSERT_EQ(setenv("FAULTY_LANDLOCK", "0", 1), 0);
  ExpectError(Error::Kind::Corrupt, "attempts: read, list, process, thread",
              [&] { this->Worker_.ReadModel(path); });
  unsetenv("FAULTY_LANDLOCK");
}

TEST_F(Faulty, AttemptsSucceedWithoutRestrictions) {
  this->Folder_.Write("beside", "text");
  const std::string command = FAULTY_WORKER + std::string(" '") + (this->Folder_ / "'");
  FILE* const output = popen(command.c_str(), "r");
  ASSERT_NE(output, nullptr);
  char line[1000] = {};
  EXPECT_NE(std::fgets(line, sizeof line, output), nullptr);
  EXPECT_EQ(pclose(output), 0);
  EXPECT_EQ(line, std::string(Possible) + "\n");
}

TEST_F(Faulty, OtherDocumentsAreReadMeanwhile) {
  const SetForNow seconds(Budget::ImportSeconds, 3);
  const std::string slow = this->File("sleep.stl");
  const std::string good = this->File("good.stl");
  bool ended = false;
  std::thread other([&] {
    ExpectError(Error::Kind::Resource, "it took too long", [&] { this->Worker_.ReadModel(slow); });
    ended = true;
  });
  EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u);
  other.join();
  EXPECT_TRUE(ended);
}

TEST_F(Faulty, WorkerThatEndedIsStartedAgain) {
  const std::string good = this->File("good.stl");
  EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u);
  const int first = this->Worker_.Process();
  ASSERT_GT(first, 0);
  ASSERT_EQ(kill(first, SIGKILL), 0);
  siginfo_t info = {};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(first), &info, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u);
  EXPECT_NE(this->Worker_.Process(), first);
}

TEST_F(Faulty, DocumentThatAnEndedWorkerHadNotReadIsReadAgain) {
  const std::string good = this->File("good.stl");
  EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u);
  const int first = this->Worker_.Process();
  ASSERT_EQ(kill(first, SIGSTOP), 0);
  std::thread reader([&] { EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u); });
  std::this_thread::sleep_for(std::chrono::milliseconds(100)); // it sends the document
  EXPECT_EQ(kill(first, SIGKILL), 0);
  reader.join();
  EXPECT_NE(this->Worker_.Process(), first);
}

// The processes of this parent that have not ended, as /proc has them.
std::vector<int> ChildrenOf(int parent) {
  std::vector<int> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string text;
    std::getline(file, text);
    std::istringstream rest(text.substr(std::min(text.size(), text.rfind(')') + 1)));
    char state = 'Z';
    int of = 0;
    if (rest >> state >> of && of == parent && state != 'Z' && state != 'X') {
      found.push_back(std::atoi(entry.path().filename().c_str()));
    }
  }
  return found;
}

TEST_F(Faulty, ChildThatEndedBeforeItsDocumentIsForkedAgain) {
  const std::string good = this->File("good.stl");
  EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u);
  const int worker = this->Worker_.Process();
  std::vector<int> ahead;
  while (ahead.empty()) { // until the time limit of the test
    ahead = ChildrenOf(worker);
  }
  for (const int process : ahead) {
    kill(process, SIGKILL);
  }
  while (ChildrenOf(worker) == ahead) {
  }
  EXPECT_EQ(this->Worker_.ReadModel(good).TriangleCount(), 1u);
  EXPECT_EQ(this->Worker_.Process(), worker);
}

TEST(ImportWorker, SaysWhichProgramIsMissing) {
  ImportWorker worker("/nowhere/dspace-import-worker");
  ExpectError(Error::Kind::Internal, "program '/nowhere/dspace-import-worker'",
              [&] { worker.ReadModel(SeedPath("text.stl")); });
}

// --- Images
// ---------------------------------------------------------------------------------------

void AppendBigEndian(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<char>(value >> shift));
  }
}

void AppendChunk(std::string& png, const std::string& type, const std::string& content) {
  AppendBigEndian(png, static_cast<std::uint32_t>(content.size()));
  const std::string chunk = type + content;
  png += chunk;
  AppendBigEndian(png,
                  static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(chunk.data()),
                                                   static_cast<uInt>(chunk.size()))));
}

// A grey PNG of zeros: small, whatever its size is.
std::string GreyPng(std::uint32_t side) {
  std::string header;
  AppendBigEndian(header, side);
  AppendBigEndian(header, side);
  header += std::string("\x8\0\0\0\0", 5);
  z_stream stream = {};
  deflateInit(&stream, 1);
  std::string row(side + 1, '\0');
  std::string packed;
  std::string out(1 << 16, '\0');
  for (std::uint32_t y = 0; y < side; ++y) {
    stream.next_in = reinterpret_cast<Bytef*>(row.data());
    stream.avail_in = side + 1;
    int state = Z_OK;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = static_cast<uInt>(out.size());
      state = deflate(&stream, y + 1 == side ? Z_FINISH : Z_NO_FLUSH);
      packed.append(out, 0, out.size() - stream.avail_out);
    } while (stream.avail_out == 0 && state != Z_STREAM_END);
  }
  deflateEnd(&stream);
  std::string png = "\x89PNG\r\n\x1a\n";
  AppendChunk(png, "IHDR", header);
  AppendChunk(png, "IDAT", packed);
  AppendChunk(png, "IEND", "");
  return png;
}

TEST(ImportWorker, ReadsImages) {
  const testing::TempFolder folder;
  const std::string path = folder.Write("small.png", GreyPng(20));
  const auto image = ImportWorker::OfProcess().ReadImage(path);
  EXPECT_EQ(image->width, 20);
  EXPECT_EQ(image->pixels, std::vector<std::uint8_t>(400, 0));
  EXPECT_EQ(image->name, path);
}

TEST(ImportWorker, RejectsAnImageOfTooManyPixels) {
  const testing::TempFolder folder;
  const std::string png = GreyPng(16000);
  EXPECT_LT(png.size(), 2000000u);
  const std::string path = folder.Write("large.png", png);
  const std::string message =
      "is an image of 16000 x 16000 x 1: too many pixels; the limit image_pixels is 134217728";
  ExpectError(Error::Kind::Resource, message, [&] { ImportWorker::OfProcess().ReadImage(path); });
  ExpectError(Error::Kind::Resource, message, [&] { ReadImage(path); });
}

TEST(ImportWorker, TakesTheLimitOfPixelsThatIsSet) {
  const testing::TempFolder folder;
  const std::string path = folder.Write("small.png", GreyPng(20));
  {
    const SetForNow pixels(Budget::ImagePixels, 399);
    ExpectError(Error::Kind::Resource, "the limit image_pixels is 399",
                [&] { ImportWorker::OfProcess().ReadImage(path); });
  }
  const SetForNow pixels(Budget::ImagePixels, 400);
  EXPECT_EQ(ImportWorker::OfProcess().ReadImage(path)->width, 20);
}

} // namespace
} // namespace dspace
