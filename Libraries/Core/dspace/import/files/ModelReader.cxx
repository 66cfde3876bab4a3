#include <dspace/import/files/ModelReader.h>

#include <cstring>
#include <new>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/Utf8.h>
#include <dspace/import/model/SolidMesh.h>

#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/Importers.h>
#include <dspace/import/model/MeshRepair.h>
#include <dspace/import/model/Normals.h>

namespace dspace {

namespace {

using Reader = Model (*)(const std::string&, const ImportOptions&);

constexpr const char* Accepted =
    "accepted are glTF 2.0 (.gltf, .glb), VRML and Inventor (.wrl, .wrz, .iv), OBJ (.obj), "
    "STL (.stl), PLY (.ply), and for robots URDF (.urdf)";

bool StartsWith(const std::string& text, const char* prefix) {
  return text.compare(0, std::strlen(prefix), prefix) == 0;
}

// The reader that the first bytes ask for, or null where they are silent.
Reader ReaderByContent(const std::string& start) {
  if (StartsWith(start, "glTF")) {
    return ReadGltf;
  }
  if (StartsWith(start, "#VRML") || StartsWith(start, "#Inventor") ||
      StartsWith(start, "\x1f\x8b")) {
    return ReadVrml;
  }
  if (StartsWith(start, "ply\n") || StartsWith(start, "ply\r")) {
    return ReadPly;
  }
  const std::size_t text = start.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (text != std::string::npos && start[text] == '{') {
    return ReadGltf;
  }
  return nullptr;
}

Reader ReaderByExtension(const std::string& extension) {
  if (extension == ".gltf" || extension == ".glb") {
    return ReadGltf;
  }
  if (extension == ".wrl" || extension == ".wrz" || extension == ".iv" || extension == ".vrml") {
    return ReadVrml;
  }
  if (extension == ".obj") {
    return ReadObj;
  }
  if (extension == ".stl") {
    return ReadStl;
  }
  return extension == ".ply" ? ReadPly : nullptr;
}

Reader ReaderFor(const std::string& path) {
  const std::string object = FileObject(path);
  const std::string start = ReadFileStart(path, 512);
  if (start.find("<robot") != std::string::npos || LowerExtension(path) == ".urdf") {
    throw Error(Error::Kind::Unsupported, object,
                "is a URDF, which has joints: read it as a robot (in Python under a name that ends "
                "in .urdf)");
  }
  if (const Reader reader = ReaderByContent(start)) {
    return reader;
  }
  if (const Reader reader = ReaderByExtension(LowerExtension(path))) {
    return reader;
  }
  // An STL by its first word is certain only where the extension says nothing else.
  if (StartsWith(start, "solid")) {
    return ReadStl;
  }
  throw Error(Error::Kind::Unsupported, object, std::string("is of no known type; ") + Accepted);
}

// The boundary for text: whatever a reader or its library made of a file's names, a Model holds
// UTF-8.
void MakeTextUtf8(Model& model) {
  const auto convert = [object = FileObject(model.path)](std::string& name) {
    name = ToFileText(std::move(name), object);
  };
  for (Mesh& mesh : model.meshes) {
    convert(mesh.name);
  }
  for (Material& material : model.materials) {
    convert(material.name);
  }
  for (ModelNode& node : model.nodes) {
    convert(node.name);
  }
  for (ModelLight& light : model.lights) {
    convert(light.name);
  }
  for (ModelAnimation& animation : model.animations) {
    convert(animation.name);
  }
  for (std::vector<std::string>* texts : {&model.warnings, &model.leftOut}) {
    for (std::string& text : *texts) {
      text = ToUtf8(std::move(text));
    }
  }
}

// One warning a mesh, which counts what was repaired and says where it is.
void RepairMeshes(Model& model) {
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    Mesh& mesh = model.meshes[i];
    const MeshFlaws flaws = RepairMesh(mesh);
    if (!flaws.Any()) {
      continue;
    }
    std::string text = mesh.name.empty() ? "mesh " + std::to_string(i) : "mesh '" + mesh.name + "'";
    const char* separator = ": ";
    const auto add = [&](std::size_t count, std::size_t first, const char* of, const char* what) {
      if (count > 0) {
        text += separator + std::string(what) + ": " + std::to_string(count) +
                " (the first: " + of + " " + std::to_string(first) + ")";
        separator = "; ";
      }
    };
    add(flaws.primitives, flaws.firstPrimitive, "face",
        "faces, lines or points with positions that are not finite are left out");
    add(flaws.normals, flaws.firstNormal, "vertex",
        "normals that are not finite or have no length are made from the faces");
    add(flaws.tcoords, flaws.firstTcoord, "vertex",
        "texture coordinates that are not finite become 0");
    model.warnings.push_back(text);
  }
}

// Something must be there to draw, and more than points unless they are what is asked for.
void CheckFaces(const Model& model, const ImportOptions& options) {
  bool more = false;
  const Mesh* points = nullptr; // the first of them
  std::size_t vertices = 0;
  for (const ModelNode& node : model.nodes) {
    for (const int index : node.meshes) {
      const Mesh& mesh = model.meshes[static_cast<std::size_t>(index)];
      if (mesh.primitive != Mesh::Primitive::Points) {
        more = more || !mesh.indices.empty();
      } else if (!mesh.indices.empty()) {
        points = points ? points : &mesh;
        vertices += mesh.VertexCount();
      }
    }
  }
  if (!more && points && !options.pointCloud) {
    throw Error(Error::Kind::Corrupt, FileObject(model.path),
                (points->name.empty() ? "" : "mesh '" + points->name + "' ") + "has " +
                    std::to_string(vertices) +
                    " vertices and no faces or lines; accepted: a mesh with faces, or "
                    "point_cloud=True to show its vertices as points");
  }
  if (!more && !points) {
    throw Error(Error::Kind::Corrupt, FileObject(model.path),
                "has nothing to draw: no faces, lines or points" +
                    (model.warnings.empty() ? "" : " (" + model.warnings.front() + ")"));
  }
}

void CheckResult(const Model& model, const ImportOptions& options) {
  const std::string object = FileObject(model.path);
  CheckModel(model);
  CheckFaces(model, options);
  if (model.TriangleCount() > options.maximumTriangles) {
    throw Error(Error::Kind::Resource, object,
                "has " + std::to_string(model.TriangleCount()) + " triangles; at most " +
                    std::to_string(options.maximumTriangles) + " are accepted");
  }
  if (options.strict && !model.warnings.empty()) {
    throw Error(Error::Kind::Corrupt, object, model.warnings.front() + " (rejected: strict)");
  }
}

} // namespace

bool IsVrmlFile(const std::string& path) {
  try {
    return ReaderFor(path) == ReadVrml;
  } catch (const Error&) {
    return false;
  }
}

Model ReadModel(const std::string& path, const ImportOptions& options) {
  try {
    Model model = ReaderFor(path)(path, options);
    model.path = path;
    MakeTextUtf8(model);
    RepairMeshes(model);
    CheckResult(model, options);
    for (std::string& warning : model.warnings) {
      if (warning.find("file '") == std::string::npos) { // as some readers leave it
        warning.insert(0, FileObject(path) + ": ");
      }
    }
    for (Mesh& mesh : model.meshes) {
      ComputeNormals(mesh);
      mesh.solid = IsSolid(mesh);
    }
    return model;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(Error::Kind::Resource, FileObject(path), "not enough memory to read it");
  } catch (const std::exception& e) {
    throw Error(Error::Kind::Corrupt, FileObject(path), std::string("cannot be read: ") + e.what());
  }
}

} // namespace dspace
