// Every mutant of a good file ends in a dspace::Error or in a model that passes CheckModel: never
// in a crash, a hang, another exception or too much memory. DSPACE_FUZZ_RUNS mutants a format
// (300), from number DSPACE_FUZZ_FIRST (0); with DSPACE_LONG 5,000 others (from 100,000). A failure
// names the format and the number.
#include "BinaryBytes.h"
#include "FuzzMutator.h"
#include "ImportTestSupport.h"
#include "Sanitized.h"
#include "TestData.h"

#include <dspace/import/urdf/Urdf.h>

#include <chrono>
#include <csignal>
#include <functional>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <zlib.h>

namespace dspace {

namespace {

using testing::AppendBinary;

constexpr int SecondsWithoutProgress = 60;
constexpr rlim_t MaximumMemory = rlim_t(4) << 30;

std::string Seed(const std::string& name) {
  return testing::ReadBytes(std::string(DSPACE_SEEDS) + "/" + name);
}

std::string BinaryStl() {
  std::string bytes(80, 's');
  AppendBinary<std::uint32_t>(bytes, 2);
  const float corners[2][12] = {{0, 0, -1, 0, 0, 0, 1, 1, 0, 1, 0, 0},
                                {0, 0, -1, 0, 0, 0, 0, 1, 0, 1, 1, 0}};
  for (const auto& triangle : corners) {
    for (const float value : triangle) {
      AppendBinary(bytes, value);
    }
    AppendBinary<std::uint16_t>(bytes, 0);
  }
  return bytes;
}

std::string BinaryPly(bool big) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\n"
                      "property float z\nproperty uchar red\nproperty uchar green\n"
                      "property uchar blue\nproperty list ushort short tags\nelement face 2\n"
                      "property list uchar uint vertex_indices\nelement extra 1\n"
                      "property list int double values\nend_header\n";
  const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& p : square) {
    AppendBinary(bytes, p[0], big);
    AppendBinary(bytes, static_cast<double>(p[1]), big);
    AppendBinary(bytes, 0.5f, big);
    bytes += "\x10\x20\x30";
    AppendBinary<std::uint16_t>(bytes, 1, big);
    AppendBinary<std::int16_t>(bytes, -7, big);
  }
  for (const std::vector<std::uint32_t>& face :
       {std::vector<std::uint32_t>{0, 1, 2}, std::vector<std::uint32_t>{0, 1, 2, 3}}) {
    bytes.push_back(static_cast<char>(face.size()));
    for (const std::uint32_t index : face) {
      AppendBinary(bytes, index, big);
    }
  }
  AppendBinary<std::int32_t>(bytes, 2, big);
  AppendBinary(bytes, 1.5, big);
  AppendBinary(bytes, 2.5, big);
  return bytes;
}

std::string Glb() {
  std::string json = Seed("part.gltf");
  const std::string uri = "\"uri\": \"part.bin\",";
  json.erase(json.find(uri), uri.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bin = Seed("part.bin");
  bin.resize((bin.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  AppendBinary<std::uint32_t>(bytes, 2);
  AppendBinary<std::uint32_t>(bytes, static_cast<std::uint32_t>(28 + json.size() + bin.size()));
  AppendBinary<std::uint32_t>(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  AppendBinary<std::uint32_t>(bytes, static_cast<std::uint32_t>(bin.size()));
  return bytes + std::string("BIN\0", 4) + bin;
}

std::string Gzip(const std::string& bytes) {
  z_stream stream = {};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

// What a child tells its parent, in memory that both see.
struct Progress {
  volatile int current; // number of the mutant being read
  volatile int models;
  volatile int errors;
  char message[400];
};

struct Format {
  std::string name;
  std::string file;                                            // of the mutant
  std::string seed;                                            // its bytes
  std::vector<std::pair<std::string, std::string>> companions; // files that it refers to
  std::string companion; // one of them that is mutated, too, in every third mutant; or ""
  bool gzip = false;     // packed, every other mutant before it is damaged
};

int Number(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

void ReadOne(const std::string& path) {
  if (path.size() > 5 && path.compare(path.size() - 5, 5, ".urdf") == 0) {
    ReadUrdf(path);
  } else {
    CheckModel(ReadModel(path));
  }
}

// A mutant's files, written into the folder; number -1 is the seed itself.
std::string WriteMutant(const Format& format, int number, const testing::TempFolder& folder) {
  testing::FuzzMutator mutator(static_cast<std::uint64_t>(number));
  const bool other = number >= 0 && number % 3 == 0 && !format.companion.empty();
  for (const auto& [name, content] : format.companions) {
    folder.Write(name, other && name == format.companion ? mutator.Mutate(content) : content);
  }
  std::string bytes = format.seed;
  const bool packFirst = format.gzip && number % 2 != 0;
  bytes = packFirst ? Gzip(bytes) : bytes;
  bytes = number < 0 || other ? bytes : mutator.Mutate(bytes);
  return folder.Write(format.file, format.gzip && !packFirst ? Gzip(bytes) : bytes);
}

// The child: reads mutants [first, last), then exits.
[[noreturn]] void RunChild(const Format& format, int first, int last, Progress& progress,
                           const testing::TempFolder& folder) {
  if (!testing::Sanitized()) { // the shadow memory of the address sanitizer needs the address space
    const rlimit memory = {MaximumMemory, MaximumMemory};
    setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit cores = {0, 0};
  setrlimit(RLIMIT_CORE, &cores);
  const rlimit cpu = {600, 600};
  setrlimit(RLIMIT_CPU, &cpu);
  const int null = open("/dev/null", O_WRONLY);
  dup2(null,
       testing::Sanitized() ? STDOUT_FILENO : STDERR_FILENO); // a sanitizer's report stays visible
  for (int number = first; number < last; ++number) {
    progress.current = number;
    const std::string path = WriteMutant(format, number, folder);
    try {
      ReadOne(path);
      progress.models = progress.models + 1;
    } catch (const Error&) {
      progress.errors = progress.errors + 1;
    } catch (const std::exception& e) {
      std::strncpy(progress.message, e.what(), sizeof progress.message - 1);
      _exit(2);
    }
  }
  _exit(0);
}

// Waits for a child, which is killed when it hangs; "" or how it failed.
std::string WaitFor(pid_t child, Progress& progress) {
  int status = 0;
  int seen = -2;
  auto since = std::chrono::steady_clock::now();
  bool hung = false;
  while (waitpid(child, &status, WNOHANG) == 0) {
    const auto now = std::chrono::steady_clock::now();
    if (progress.current != seen) {
      seen = progress.current;
      since = now;
    } else if (!hung && now - since > std::chrono::seconds(SecondsWithoutProgress)) {
      hung = true;
      kill(child, SIGKILL);
    }
    usleep(2000);
  }
  if (hung) {
    return "hangs";
  }
  if (WIFSIGNALED(status)) {
    return "dies of signal " + std::to_string(WTERMSIG(status));
  }
  return WEXITSTATUS(status) == 0
             ? ""
             : "exits with " + std::to_string(WEXITSTATUS(status)) + ": " + progress.message;
}

// Reads [first, last) in children, a new one after each that failed.
void FuzzRange(const Format& format, int first, int last, Progress& progress) {
  const testing::TempFolder folder;
  int failures = 0;
  for (int next = first; next < last && failures < 20;) {
    progress.current = next;
    progress.message[0] = '\0';
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      RunChild(format, next, last, progress, folder);
    }
    const std::string failure = WaitFor(child, progress);
    if (failure.empty()) {
      break;
    }
    ++failures;
    ADD_FAILURE() << format.name << ": mutant " << progress.current << " " << failure;
    next = progress.current + 1;
  }
}

// `share`: one in so many of the mutants asked for.
void Fuzz(const Format& format, int share = 1) {
  void* shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  Progress& progress = *static_cast<Progress*>(shared);
  FuzzRange(format, -1, 0, progress);
  EXPECT_EQ(progress.models, 1) << "the seed itself is not read";
  const char* given = std::getenv("DSPACE_LONG");
  const bool isLong = given && *given;
  const int first = Number("DSPACE_FUZZ_FIRST", isLong ? 100000 : 0);
  const int runs = Number("DSPACE_FUZZ_RUNS", isLong ? 5000 : 300) / share;
  FuzzRange(format, first, first + runs, progress);
  std::cout << "  " << format.name << ": " << runs << " mutants from " << first << ", "
            << progress.models << " models, " << progress.errors << " errors\n";
  if (runs >= 100) {
    // Mutants that all fail, or all pass, would test little.
    EXPECT_GT(progress.models, 1);
    EXPECT_GT(progress.errors, 0);
  }
  munmap(shared, sizeof(Progress));
}

} // namespace

// The runner itself: what it says of children that end badly.
TEST(ImportFuzz, RunnerSeesCrashesAndExceptions) {
  void* shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  Progress& progress = *static_cast<Progress*>(shared);
  const auto run = [&progress](auto&& action) {
    const pid_t child = fork();
    if (child == 0) {
      action();
      _exit(0);
    }
    return WaitFor(child, progress);
  };
  EXPECT_EQ(run([] {}), "");
  EXPECT_EQ(run([] { raise(SIGKILL); }), "dies of signal 9");
  EXPECT_EQ(run([&progress] {
              std::strcpy(progress.message, "oops");
              _exit(2);
            }),
            "exits with 2: oops");
  munmap(shared, sizeof(Progress));
}

// A tenth of the mutants for each of some real files, which are larger and have other exporters.
TEST(ImportFuzz, RealFiles) {
  DSPACE_REAL_DATA(folder, "models");
  const auto real = [&folder](const char* name) { return testing::ReadBytes(folder + "/" + name); };
  for (const Format& format : {
           Format{"Rocky7Body", "mutant.wrl", real("rocky7_vrml/Rocky7Body.wrl"), {}, "", false},
           Format{"lander2", "mutant.wrl", real("pathfinder_vrml/lander2.wrl"), {}, "", false},
           Format{"HelloWorld",
                  "mutant.wrl",
                  real("vrml97_samples/HelloWorld.wrl"),
                  {{"earth-topo.png", real("vrml97_samples/earth-topo.png")}},
                  "earth-topo.png",
                  false},
           Format{"viper suspension",
                  "mutant.obj",
                  real("viper_obj/viper_L_bt_sus.obj"),
                  {},
                  "",
                  false},
           Format{"m2020 bit",
                  "mutant.gltf",
                  real("m2020_rover/meshes/LaunchBitInTurretAtZeroFeed.gltf"),
                  {{"LaunchBitInTurretAtZeroFeed.bin",
                    real("m2020_rover/meshes/LaunchBitInTurretAtZeroFeed.bin")}},
                  "LaunchBitInTurretAtZeroFeed.bin",
                  false},
           Format{"m2020", "mutant.urdf", real("m2020_rover/m2020.urdf"), {}, "", false},
           Format{"parker", "mutant.glb", real("spacecraft_glb/parker.glb"), {}, "", false},
       }) {
    Fuzz(format, 10);
  }
}

TEST(ImportFuzz, Vrml2) {
  Fuzz({"VRML 2.0", "mutant.wrl", Seed("vrml2.wrl"), {}, "", false});
}

TEST(ImportFuzz, Vrml1) {
  Fuzz({"VRML 1.0", "mutant.wrl", Seed("vrml1.wrl"), {}, "", false});
}

TEST(ImportFuzz, VrmlInline) {
  Fuzz({"VRML Inline",
        "mutant.wrl",
        "#VRML V2.0 utf8\nTransform { children [ Inline { url \"a.wrl\" } Inline { url \"b.wrl\" } "
        "] }\n"
        "Inline { url [ \"c.wrl\" \"a.wrl\" ] }",
        {{"a.wrl", Seed("vrml2.wrl")}, {"b.wrl", Seed("vrml1.wrl")}},
        "a.wrl",
        false});
}

TEST(ImportFuzz, VrmlGzip) {
  Fuzz({"VRML gzip", "mutant.wrz", Seed("vrml2.wrl"), {}, "", true});
}

TEST(ImportFuzz, StlText) {
  Fuzz({"STL text", "mutant.stl", Seed("text.stl"), {}, "", false});
}

TEST(ImportFuzz, StlBinary) {
  Fuzz({"STL binary", "mutant.stl", BinaryStl(), {}, "", false});
}

TEST(ImportFuzz, PlyText) {
  Fuzz({"PLY text", "mutant.ply", Seed("text.ply"), {}, "", false});
}

TEST(ImportFuzz, PlyLittleEndian) {
  Fuzz({"PLY little-endian", "mutant.ply", BinaryPly(false), {}, "", false});
}

TEST(ImportFuzz, PlyBigEndian) {
  Fuzz({"PLY big-endian", "mutant.ply", BinaryPly(true), {}, "", false});
}

TEST(ImportFuzz, Obj) {
  Fuzz(
      {"OBJ", "mutant.obj", Seed("part.obj"), {{"part.mtl", Seed("part.mtl")}}, "part.mtl", false});
}

TEST(ImportFuzz, Gltf) {
  Fuzz({"glTF",
        "mutant.gltf",
        Seed("part.gltf"),
        {{"part.bin", Seed("part.bin")}},
        "part.bin",
        false});
}

TEST(ImportFuzz, Glb) {
  Fuzz({"GLB", "mutant.glb", Glb(), {}, "", false});
}

TEST(ImportFuzz, Urdf) {
  Fuzz({"URDF", "mutant.urdf", Seed("arm.urdf"), {{"part.obj", Seed("part.obj")}}, "", false});
}

} // namespace dspace
