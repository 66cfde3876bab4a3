// Mutants of VRML and glTF that are changed by their structure, not by their bytes, so that most
// get past the parser: each is read in a process of its own (ImportWorker.h), with 1 GiB and 20 s,
// and ends in a model or an Error. An Error that tells of the end of that process is a failure: of
// the reader, which the process contains. DSPACE_FUZZ_RUNS mutants a kind (300), from number
// DSPACE_FUZZ_FIRST (0); with DSPACE_LONG 20,000 others (from 100,000).
#include "BinaryBytes.h"
#include "FuzzMutator.h"
#include "GltfTrees.h"
#include "ImportTestSupport.h"
#include "TestData.h"
#include "VrmlTrees.h"

#include <dspace/Budgets.h>
#include <dspace/import/worker/ImportWorker.h>

#include <functional>
#include <iostream>

namespace dspace {
namespace {

using testing::FuzzMutator;

std::string Seed(const std::string& name) {
  return testing::ReadBytes(std::string(DSPACE_SEEDS) + "/" + name);
}

int Number(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

class ImportTrees : public ::testing::Test {
protected:
  ImportTrees() {
    SetBudget("import_memory", std::uint64_t(1) << 30);
    SetBudget("import_seconds", 20);
  }
  ~ImportTrees() override {
    for (const BudgetInfo& info : Budgets()) {
      SetBudget(info.name, info.standard);
    }
  }

  void Fuzz(const std::string& file, const std::function<std::string(FuzzMutator&)>& mutant) {
    const char* given = std::getenv("DSPACE_LONG");
    const bool isLong = given && *given;
    const int first = Number("DSPACE_FUZZ_FIRST", isLong ? 100000 : 0);
    const int runs = Number("DSPACE_FUZZ_RUNS", isLong ? 20000 : 300);
    int models = 0;
    int errors = 0;
    int failures = 0;
    for (int number = first; number < first + runs && failures < 20; ++number) {
      FuzzMutator random(static_cast<std::uint64_t>(number));
      const std::string path = this->Folder_.Write(file, mutant(random));
      try {
        ImportWorker::OfProcess().ReadModel(path);
        ++models;
      } catch (const Error& error) {
        const std::string message = error.what();
        const bool ended = message.find("the process that reads it") != std::string::npos ||
                           message.find("too long to read") != std::string::npos ||
                           message.find("import_memory") != std::string::npos;
        if (ended) {
          ADD_FAILURE() << file << ": mutant " << number << ": " << message;
        }
        failures += ended;
        ++errors;
      }
    }
    std::cout << "  " << file << ": " << runs << " mutants from " << first << ", " << models
              << " models, " << errors << " errors\n";
    if (runs >= 100) { // mutants that all fail, or all pass, would test little
      EXPECT_GT(models, runs / 50);
      EXPECT_GT(errors, runs / 50);
    }
  }

  testing::TempFolder Folder_;
};

TEST_F(ImportTrees, Vrml2) {
  const std::string seed = Seed("vrml2.wrl");
  this->Fuzz("mutant2.wrl", [&](FuzzMutator& random) {
    return testing::VrmlTreeMutator(random, VrmlDialect::Vrml2).Mutate(seed);
  });
}

TEST_F(ImportTrees, Vrml1) {
  const std::string seed = Seed("vrml1.wrl");
  this->Fuzz("mutant1.wrl", [&](FuzzMutator& random) {
    return testing::VrmlTreeMutator(random, VrmlDialect::Vrml1).Mutate(seed);
  });
}

TEST_F(ImportTrees, Gltf) {
  const std::string seed = Seed("part.gltf");
  this->Folder_.Write("part.bin", Seed("part.bin"));
  this->Fuzz("mutant.gltf",
             [&](FuzzMutator& random) { return testing::GltfTreeMutator(random).Mutate(seed); });
}

// The tree itself: text that is read and printed is the same to a reader.
TEST_F(ImportTrees, KeepTheMeaningOfText) {
  const std::string seed = Seed("vrml2.wrl");
  testing::VrmlTree tree;
  std::size_t at = 0;
  testing::ParseVrmlTree(seed, at, tree);
  std::string printed = "#VRML V2.0 utf8\n";
  testing::PrintVrmlTree(tree, printed);
  const Model before = ReadModel(this->Folder_.Write("a.wrl", seed));
  const Model after = ReadModel(this->Folder_.Write("b.wrl", printed));
  EXPECT_EQ(after.TriangleCount(), before.TriangleCount());
  EXPECT_EQ(after.nodes.size(), before.nodes.size());
  EXPECT_EQ(after.Bounds().max(), before.Bounds().max());
  EXPECT_EQ(after.Bounds().min(), before.Bounds().min());
}

} // namespace
} // namespace dspace
