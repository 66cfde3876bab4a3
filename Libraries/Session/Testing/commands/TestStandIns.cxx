// What stands in for a robot's meshes that cannot be read, against bounds worked out by hand.
#include <map>

#include "CommandTestSupport.h"
#include "TestData.h"

namespace dspace::testing {
namespace {

class StandIns : public CommandTest {
protected:
  v1::Reply Load(const std::string& path, bool strict = false) {
    v1::Command command;
    command.mutable_load_robot()->set_path(path);
    command.mutable_load_robot()->set_strict(strict);
    return this->Interpreter_.Execute(command);
  }

  // Bounds in their links' frames of what is drawn in the stand-ins' colour, by link.
  std::map<std::string, Eigen::AlignedBox3d> Boxes() {
    const Scene& scene = *this->Interpreter_.FindScene("scene");
    std::map<std::string, Eigen::AlignedBox3d> boxes;
    for (const auto& [id, object] : scene.Objects()) {
      for (const Part& part : object.levels.at(0).parts) {
        for (std::size_t i = 0; i < part.mesh->VertexCount(); ++i) {
          if (part.material && part.material->name == "stand-in") {
            const Eigen::Vector3f p(&part.mesh->positions[3 * i]);
            boxes[scene.Frames().Name(object.frame)].extend(object.X_FO * part.X_OP *
                                                            p.cast<double>());
          }
        }
      }
    }
    return boxes;
  }

  static void ExpectBox(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& low,
                        const Eigen::Vector3d& high) {
    EXPECT_LT((box.min() - low).norm(), 1e-6) << box.min().transpose();
    EXPECT_LT((box.max() - high).norm(), 1e-6) << box.max().transpose();
  }
};

std::string UrdfOf(const std::string& mesh) {
  return "<robot name=\"r\"><link name=\"body\"><visual>"
         "<origin xyz=\"1 2 3\" rpy=\"0 0 1.5707963267948966\"/><geometry><mesh filename=\"" +
         mesh + "\" scale=\"0.5 1 -2\"/></geometry></visual></link></robot>";
}

// A turned node with a stretched child, and normalized integers on a node with a matrix.
std::string Gltf(const std::string& bounds = R"(, "min": [0, 0, 0], "max": [4, 1, 0.5])",
                 const std::string& roots = "0") {
  return R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "absent.bin", "byteLength": 99}],
    "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3")" +
         bounds + R"(},
      {"componentType": 5122, "normalized": true, "count": 3, "type": "VEC3",
       "min": [-32767, 0, 0], "max": [0, 32767, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]},
               {"primitives": [{"attributes": {"POSITION": 1}}]}],
    "nodes": [{"translation": [10, 0, 0], "children": [1],
               "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757]},
              {"scale": [1, 2, 3], "mesh": 0},
              {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,-2,1], "mesh": 1}],
    "scenes": [{"nodes": [)" +
         roots + "]}]}";
}

TEST_F(StandIns, HaveTheBoundsThatTheFileStates) {
  const TemporaryFile mesh("part.gltf", Gltf(R"(, "min": [0, 0, 0], "max": [4, 1, 0.5])", "0, 2"));
  const TemporaryFile file("part.urdf", UrdfOf("part.gltf"));
  EXPECT_EQ(this->Load(file.Path(), true).error().kind(), v1::Error::NOT_FOUND);
  const v1::Reply reply = this->Load(file.Path());
  ASSERT_FALSE(reply.has_error()) << reply.error().message();
  // The first mesh, 4 x 2 x 1.5 after its scale, lies turned at x 8 to 10, y 0 to 4; the second
  // reaches to x = -1 and z = -2. Bounds: -1 0 -2 to 10 4 1.5. The URDF's scale makes them
  // -0.5 0 -3 to 5 4 4; its turn and origin follow.
  ExpectBox(this->Boxes()["body"], {1 - 4, 2 - 0.5, 3 - 3}, {1 - 0, 2 + 5, 3 + 4});
  ASSERT_EQ(reply.warning_size(), 1);
  for (const char* part :
       {"absent.bin", "the edges of an orange box of 5.5 x 4 x 7 m", "replace it", "part.gltf"}) {
    EXPECT_NE(reply.warning(0).find(part), std::string::npos) << reply.warning(0);
  }
}

TEST_F(StandIns, AreSmallCubesWhereNothingIsStated) {
  const auto cube = [this](const std::string& name, const std::string& content) {
    const TemporaryFile mesh(name, content);
    const TemporaryFile file("small.urdf", UrdfOf(name));
    const v1::Reply reply = this->Load(file.Path());
    ASSERT_EQ(reply.warning_size(), 1) << reply.error().message();
    EXPECT_NE(reply.warning(0).find("a cube of 0.1 m replaces it"), std::string::npos)
        << reply.warning(0);
    ExpectBox(this->Boxes()["body"], {0.95, 1.95, 2.95}, {1.05, 2.05, 3.05});
    v1::Command remove;
    remove.mutable_remove_robot()->set_robot("r");
    this->Accept(remove);
  };
  cube("none.gltf", Gltf(""));
  cube("huge.gltf", Gltf(R"(, "min": [0, 0, 0], "max": [1e30, 1, 1])"));
  cube("damaged.gltf", Gltf().substr(0, 300));
  cube("point.gltf", Gltf(R"(, "min": [0, 0, 0], "max": [0, 0])"));
  cube("damaged.stl", "solid");
  const TemporaryFile file("small.urdf", UrdfOf("nowhere.gltf")); // no file at all
  const v1::Reply reply = this->Load(file.Path());
  ASSERT_EQ(reply.warning_size(), 1);
  EXPECT_NE(reply.warning(0).find("nowhere.gltf' does not exist; a cube of 0.1 m"),
            std::string::npos)
      << reply.warning(0);
  ExpectBox(this->Boxes()["body"], {0.95, 1.95, 2.95}, {1.05, 2.05, 3.05});
}

TEST_F(StandIns, OfPerseveranceAreAsLargeAsItsChassisAndTurret) {
  DSPACE_REAL_DATA(path, "models/m2020_rover/m2020.urdf");
  const v1::Reply reply = this->Load(path);
  ASSERT_FALSE(reply.has_error()) << reply.error().message();
  EXPECT_EQ(reply.warning_size(), 2);
  const std::map<std::string, Eigen::AlignedBox3d> boxes = this->Boxes();
  ASSERT_EQ(boxes.size(), 2u);
  // From CHASSIS.gltf's and Turret.gltf's accessors, and the visuals' origins in the URDF.
  const Eigen::Vector3d origin(0.09002, 0, -1.13338);
  for (const auto& [link, box] : boxes) {
    if (box.sizes().x() > 1) {
      ExpectBox(box, origin + Eigen::Vector3d(-1.730780005, -0.774339020, -0.714996994),
                origin + Eigen::Vector3d(1.292750001, 0.908998013, 0.573002994));
    } else {
      ExpectBox(box, {2.367120028, -0.597981989, -0.161944002},
                {3.076770067, 0.066767000, 0.146090999});
    }
  }
  EXPECT_NE(reply.warning(0).find("an orange box of 3.02 x 1.68 x 1.29 m"), std::string::npos)
      << reply.warning(0);
}

} // namespace
} // namespace dspace::testing
