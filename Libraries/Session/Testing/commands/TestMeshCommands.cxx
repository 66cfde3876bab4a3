// Objects made of arrays and their parts: checks, sharing, replies, snapshots, recordings.
#include <cstring>
#include <filesystem>

#include <dspace/ledger/Ledger.h>
#include <dspace/messages/MeshMessages.h>
#include <dspace/recording/RecordedFiles.h>
#include <dspace/recording/RecordingCheck.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

template<class T> std::string Bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

const std::string TriangleBytes = Bytes<float>({0, 0, 0, 2, 0, 0, 0, 2, 0});

v1::Command Create(const std::string& name, const std::string& positions = TriangleBytes) {
  v1::Command command;
  command.mutable_create_mesh()->mutable_object()->set_name(name);
  v1::MeshData* mesh = command.mutable_create_mesh()->add_level()->add_mesh();
  mesh->set_part("wing");
  mesh->set_position(positions);
  return command;
}

v1::MeshData& MeshIn(v1::Command& command) {
  return *command.mutable_create_mesh()->mutable_level(0)->mutable_mesh(0);
}

class MeshCommands : public CommandTest {
protected:
  const GraphicsObject& Object(ObjectId id) {
    return this->Interpreter_.FindScene("scene")->Object(id);
  }
  v1::MeshReply Get(ObjectId id) {
    v1::Command command;
    command.mutable_get_mesh()->set_object(id);
    return this->Accept(command).mesh();
  }
  v1::Command SetPart(ObjectId id, const std::string& part) {
    v1::Command command;
    command.mutable_set_part()->set_object(id);
    command.mutable_set_part()->set_part(part);
    return command;
  }
};

TEST_F(MeshCommands, ArraysBecomeAMeshWithNormalsAndIndices) {
  v1::Command create = Create("sheet");
  MeshIn(create).mutable_origin()->set_x(1e9);
  const ObjectId id = this->Accept(create).object().object();
  const Part& part = this->Object(id).levels[0].parts[0];
  EXPECT_EQ(part.name, "wing");
  EXPECT_EQ(part.mesh->indices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(part.mesh->normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(part.X_OP.translation().x(), 1e9);
  const v1::MeshReply reply = this->Get(id);
  ASSERT_EQ(reply.mesh_size(), 1);
  EXPECT_EQ(reply.mesh(0).position(), TriangleBytes);
  EXPECT_EQ(reply.mesh(0).origin().x(), 1e9);
  EXPECT_EQ(reply.mesh(0).part(), "wing");
}

TEST_F(MeshCommands, EqualArraysAreOneMesh) {
  v1::Command one = Create("one"), two = Create("two"), other = Create("other");
  MeshIn(two).set_part("tail"); // names, origins and materials are no arrays
  MeshIn(two).mutable_origin()->set_y(5);
  MeshIn(two).mutable_material()->set_opacity(0.5);
  MeshIn(other).set_primitive(v1::MeshData::POINTS);
  std::vector<const Mesh*> meshes;
  for (v1::Command* command : {&one, &two, &other}) {
    meshes.push_back(
        this->Object(this->Accept(*command).object().object()).levels[0].parts[0].mesh.get());
  }
  EXPECT_EQ(meshes[0], meshes[1]);
  EXPECT_NE(meshes[0], meshes[2]);
  EXPECT_EQ(MeshIn(one).digest(), MeshIn(two).digest());
  EXPECT_NE(MeshIn(one).digest(), MeshIn(other).digest());
}

TEST_F(MeshCommands, TurnedPartsAreGivenInTheObjectsAxes) {
  // As a stretched and mirrored model would have: here by hand.
  const ObjectId id = this->AddBox("box");
  const auto scene = this->Interpreter_.FindScene("scene");
  std::vector<DetailLevel> levels = scene->Object(id).levels;
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.linear() = Eigen::Vector3d(-2, 1, 1).asDiagonal();
  X.translation() = Eigen::Vector3d(3, 0, 0);
  levels[0].parts[0].X_OP = X;
  const std::shared_ptr<const Mesh> mesh = levels[0].parts[0].mesh;
  scene->SetObjectLevels(id, std::move(levels));
  const v1::MeshData data = this->Get(id).mesh(0);
  std::vector<float> p(data.position().size() / 4), n(data.normal().size() / 4);
  std::vector<std::uint32_t> index(data.index().size() / 4);
  std::memcpy(p.data(), data.position().data(), data.position().size());
  std::memcpy(n.data(), data.normal().data(), data.normal().size());
  std::memcpy(index.data(), data.index().data(), data.index().size());
  ASSERT_EQ(p.size(), mesh->positions.size());
  for (std::size_t i = 0; i < p.size(); i += 3) {
    EXPECT_EQ(p[i], -2 * mesh->positions[i]);
    EXPECT_EQ(p[i + 1], mesh->positions[i + 1]);
  }
  // Faces still turn counter-clockwise about their normals, which point away from the middle.
  const auto vertex = [&p](std::uint32_t i) { return Eigen::Vector3f(p.data() + 3 * i); };
  for (std::size_t i = 0; i < index.size(); i += 3) {
    const Eigen::Vector3f a = vertex(index[i]), b = vertex(index[i + 1]), c = vertex(index[i + 2]);
    const Eigen::Vector3f normal(n.data() + 3 * index[i]);
    EXPECT_GT((b - a).cross(c - a).dot(normal), 0);
    EXPECT_GT(normal.dot(a), 0);
  }
}

TEST_F(MeshCommands, BadArraysAreRejectedByName) {
  v1::Command there = Create("there");
  const ObjectId id = this->Accept(there).object().object();
  const auto reject = [&](auto change, const std::string& text) {
    v1::Command create = Create("bad");
    change(MeshIn(create));
    this->Reject(create, v1::Error::INVALID_ARGUMENT, text);
    v1::Command set;
    set.mutable_set_mesh()->set_object(id);
    *set.mutable_set_mesh()->mutable_level() = create.create_mesh().level();
    this->Reject(set, v1::Error::INVALID_ARGUMENT, text);
  };
  const auto cut = [](std::string bytes) { return bytes.substr(0, bytes.size() - 1); };
  reject([&](auto& m) { m.set_position(cut(TriangleBytes)); },
         "part 'wing': the array of its positions has 35 bytes; accepted: a multiple of 12");
  reject([&](auto& m) { m.set_position(""); }, "it has no points; accepted: 1 or more");
  reject([&](auto& m) { m.set_position(Bytes<float>({0, 0, NAN})); }, "a number of its positions");
  reject([&](auto& m) { m.set_position(Bytes<float>({0, 0, 0, 1, 1, 1})); }, "indices");
  reject([&](auto& m) { m.set_normal(TriangleBytes); }, "the normal of vertex 0 has length 0");
  reject([&](auto& m) { m.set_normal("abc"); }, "the array of its normals has 3 bytes");
  reject([&](auto& m) { m.set_normal(Bytes<float>({0, 0, 1})); }, "numbers of normals");
  reject([&](auto& m) { m.set_tcoord(Bytes<float>({0, 0})); }, "numbers of texture coordinates");
  reject([&](auto& m) { m.set_color("rgba"); }, "4 bytes of colours; accepted: none or 12");
  reject([&](auto& m) { m.set_index(Bytes<std::uint32_t>({0, 1, 3})); }, "index 3");
  reject([&](auto& m) { m.set_index(Bytes<std::uint32_t>({0, 1})); }, "it has 2 indices");
  reject([&](auto& m) { m.set_primitive(v1::MeshData::Primitive(7)); }, "its primitive is 7");
  reject([&](auto& m) { m.mutable_origin()->set_x(INFINITY); }, "its origin");
  reject([&](auto& m) { m.mutable_material()->set_wireframe(true); }, "wireframe");
  reject([&](auto& m) { m.mutable_material()->mutable_color()->set_r(2); }, "accepted: ");
  reject(
      [&](auto& m) {
        m.set_digest("x");
        m.clear_position();
      },
      "its arrays are in a recording");
  v1::Command none;
  none.mutable_create_mesh();
  this->Reject(none, v1::Error::INVALID_ARGUMENT, "it has no level of detail");
  none.mutable_create_mesh()->add_level();
  this->Reject(none, v1::Error::INVALID_ARGUMENT, "level 0 has no points");
  v1::Command set;
  set.mutable_set_mesh()->set_object(this->AddBox("box"));
  *set.mutable_set_mesh()->mutable_level() = there.create_mesh().level();
  this->Reject(set, v1::Error::INVALID_ARGUMENT, "object 'box': it is not made of arrays");
}

TEST_F(MeshCommands, PartsAreOverriddenByName) {
  v1::Command create = Create("sheet");
  const ObjectId id = this->Accept(create).object().object();
  v1::Command set = this->SetPart(id, "wing");
  set.mutable_set_part()->mutable_material()->mutable_emissive()->set_g(1);
  set.mutable_set_part()->set_visible(false);
  this->Accept(set);
  v1::Command again = this->SetPart(id, "wing");
  again.mutable_set_part()->mutable_material()->set_opacity(0.5);
  this->Accept(again);
  const PartOverride& over = this->Object(id).parts.at("wing");
  EXPECT_EQ(over.material.emissive->at(1), 1.0);
  EXPECT_EQ(over.material.opacity, 0.5);
  EXPECT_FALSE(over.visible);
  again.mutable_set_part()->set_replace(true);
  this->Accept(again);
  EXPECT_FALSE(this->Object(id).parts.at("wing").material.emissive);
  EXPECT_FALSE(this->Object(id).parts.at("wing").visible);
  this->Reject(this->SetPart(id, "tail"), v1::Error::NOT_FOUND,
               "object 'sheet', part 'tail': no part has this name; accepted: 'wing'");
  again.mutable_set_part()->mutable_material()->set_opacity(2);
  this->Reject(again, v1::Error::INVALID_ARGUMENT, "opacity is 2; accepted: 0 to 1");
}

// --- Recordings ----------------------------------------------------------------------------------

TEST_F(MeshCommands, ARecordingStoresEqualArraysOnceAndGivesThemBack) {
  const TemporaryFolder folder;
  const std::string path = (folder.Path() / "run.dspace").string();
  session::Ledger ledger;
  v1::Command scene;
  scene.mutable_create_scene();
  ledger.Add(scene, {});
  std::vector<v1::Command> given;
  std::vector<float> points(3 * 100000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = std::sin(float(i) * float(i));
  }
  {
    session::RecordingWriter writer(path, ledger, 0.0);
    v1::Command command = Create("cloud", Bytes(points));
    MeshIn(command).set_primitive(v1::MeshData::POINTS);
    const ObjectId id = this->Accept(command).object().object();
    for (int i = 0; i < 5; ++i) {
      if (i > 0) {
        const v1::Command created = given.front();
        command.mutable_set_mesh()->set_object(id);
        *command.mutable_set_mesh()->mutable_level() = created.create_mesh().level();
        this->Accept(command);
      }
      ledger.Add(command, {});
      EXPECT_EQ(writer.Add(command, {}, ledger), "");
      given.push_back(command);
    }
    EXPECT_EQ(writer.Flush(), "");
    EXPECT_LT(writer.Counts().bytes, 1000u); // without the arrays
  }
  EXPECT_LT(std::filesystem::file_size(path), 2 * 4 * points.size()); // five would be 5 times
  session::RecordingReader reader(path);
  EXPECT_NO_THROW(session::CheckRecording(reader, [] {}));
  session::RecordedFiles files(reader);
  EXPECT_EQ(files.Folder(), ""); // arrays are no files
  std::size_t i = 0;
  reader.Read(1, reader.Last(), [&](session::RecordedCommand&& row) {
    v1::Command command = row.command;
    EXPECT_LT(command.ByteSizeLong(), 200u);
    files.FillIn(command);
    EXPECT_EQ(command.SerializeAsString(), given[i++].SerializeAsString());
    return true;
  });
  EXPECT_EQ(i, given.size());
  v1::Command forged = given.front();
  MeshIn(forged).clear_position();
  MeshIn(forged).set_digest(std::string(32, 'x'));
  EXPECT_THROW(files.FillIn(forged), Error);
}

TEST_F(MeshCommands, ASnapshotHoldsTheLastArraysOnly) {
  session::Ledger ledger;
  v1::Command scene;
  scene.mutable_create_scene();
  ledger.Add(scene, {});
  const auto apply = [&](v1::Command& command) { ledger.Add(command, this->Accept(command)); };
  v1::Command create = Create("sheet");
  apply(create);
  const ObjectId id = create.create_mesh().object().id();
  v1::Command part = this->SetPart(id, "wing");
  part.mutable_set_part()->set_visible(false);
  apply(part);
  v1::Command other = Create("", Bytes<float>({0, 0, 0, 3, 0, 0, 0, 3, 0}));
  MeshIn(other).set_part("tail");
  v1::Command set;
  set.mutable_set_mesh()->set_object(id);
  *set.mutable_set_mesh()->mutable_level() = other.create_mesh().level();
  apply(set);
  session::Interpreter restored;
  int meshes = 0;
  for (v1::Command command : ledger.Commands()) {
    const v1::Reply reply = restored.Execute(command);
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
    session::ForEachMesh(command, [&](v1::MeshData& mesh) {
      ++meshes;
      EXPECT_EQ(mesh.part(), "tail");
    });
  }
  EXPECT_EQ(meshes, 1);
  EXPECT_EQ(PictureOf(restored), this->Picture());
}

} // namespace
} // namespace dspace::testing
