// ReadModel on VRML: files that are rejected, and what is left out with a warning.
#include "VrmlTestSupport.h"

namespace dspace::testing {
namespace {

// ---- bad input --------------------------------------------------------------------------------

TEST(ImportVrml, BadFiles) {
  const TempFolder folder;
  const auto bad = [&folder](Error::Kind kind, const std::string& part, const std::string& text) {
    ExpectReadError(kind, part, folder.Write("bad.wrl", text));
  };
  ExpectReadError(Error::Kind::NotFound, "absent.wrl", folder / "absent.wrl");
  bad(Error::Kind::Corrupt, "is empty", "");
  bad(Error::Kind::Corrupt, "does not begin with", "hello");
  bad(Error::Kind::Unsupported, "'#VRML V3.0 utf8' is not read", "#VRML V3.0 utf8\n");
  bad(Error::Kind::Unsupported, "binary", "#Inventor V2.1 binary\n");
  bad(Error::Kind::Corrupt, "nothing to draw", Head2);
  bad(Error::Kind::Corrupt, "nothing to draw", Head2 + "Group { }");
  bad(Error::Kind::Corrupt, "NUL bytes", Head2 + std::string("Group {\0}", 9));
  const std::string good = Head2 + "\n" + Shape(Triangle());
  for (std::size_t size = good.size() - 3; size > Head2.size() + 7; --size) {
    bad(Error::Kind::Corrupt, "line 3", good.substr(0, size)); // cut anywhere: it says where
  }
  bad(Error::Kind::Corrupt, "gzip stream", Gzip(good).substr(0, 60));
  bad(Error::Kind::Corrupt, "line 2: found 'nan' where a finite number is expected",
      Head2 + "Transform { translation nan 0 0 }");
  bad(Error::Kind::Corrupt, "found '1e39'", Head2 + "Transform { translation 1e39 0 0 }");
  bad(Error::Kind::Corrupt, "found '4294967296' where an integer",
      Head2 + Shape("IndexedFaceSet { coordIndex [ 4294967296 ] }"));
  bad(Error::Kind::Corrupt, "found 'Z' where TRUE or FALSE",
      Head2 + Shape("IndexedFaceSet { solid Z }"));
  bad(Error::Kind::Corrupt, "does not end", Head2 + "WorldInfo { title \"abc }");
}

// Coin frees the first value, and crashes at its USE: each of these ended the process.
TEST(ImportVrml, FieldsOfNodesThatAreGivenTwice) {
  const TempFolder folder;
  const auto bad = [&folder](const std::string& field, const std::string& text) {
    for (const std::string& bytes : {Head2 + text, Gzip(Head2 + text)}) {
      ExpectReadError(Error::Kind::Corrupt, "field " + field + " is given twice",
                      folder.Write("bad.wrl", bytes));
    }
  };
  const std::string points = "Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] }";
  const std::string twice = "Shape { geometry DEF A Box { } geometry Sphere { } }\n";
  bad("'geometry' of Shape", twice + Shape("USE A"));
  bad("'geometry' of Shape", "Shape { geometry DEF A Box { } geometry NULL }\n" + Shape("USE A"));
  bad("'appearance' of Shape",
      "Shape { appearance DEF A Appearance { } appearance Appearance { } geometry Box { } }\n" +
          Shape("Box { }", "appearance USE A"));
  bad("'appearance' of Shape", // the DEF stands deeper
      "Shape { appearance Appearance { material DEF A Material { } } appearance Appearance { } "
      "geometry Box { } }\n" +
          Shape("Box { }", "appearance Appearance { material USE A }"));
  bad("'material' of Appearance",
      Shape("Box { }", "appearance Appearance { material DEF A Material { } material Material { } "
                       "}") +
          Shape("Box { }", "appearance Appearance { material USE A }"));
  bad("'coord' of IndexedFaceSet", Shape("IndexedFaceSet { coord DEF A " + points + " coord " +
                                         points + " coordIndex [ 0 1 2 -1 ] }") +
                                       Shape("PointSet { coord USE A }"));
  bad("'proxy' of Collision", "Collision { proxy DEF A " + Shape("Box { }") +
                                  "proxy Group { } }\nGroup { children [ USE A ] }");
  bad("'children' of Group", "Group { children [ DEF A Group { children [ DEF B " +
                                 Shape("Box { }") +
                                 " ] } ] children [ ] }\nGroup { children [ USE A USE B ] }");
  // In a PROTO's body, through IS, and in an instance.
  bad("'geometry' of Shape",
      "PROTO P [ ] { Group { children [ " + twice + Shape("USE A") + " ] } }\nP { }");
  bad("'geometry' of Shape",
      "PROTO P [ field SFNode g Sphere { } ] { Group { children [ Shape { geometry DEF A Box { } "
      "geometry IS g } " +
          Shape("USE A") + " ] } }\nP { }");
  bad("'g' of P", "PROTO P [ field SFNode g Sphere { } ] { " + Shape("IS g") +
                      " }\nP { g DEF A Box { } g Sphere { } }\n" + Shape("USE A"));
  bad("'g' of P", "PROTO P [ field MFNode g [ ] ] { Group { children IS g } }\nP { g [ DEF A " +
                      Shape("Box { }") + " ] g [ ] }\nGroup { children [ USE A ] }");
  // Fields without nodes: the last value holds, as in Coin.
  const Model model = Read(folder, Head2 + Shape("Box { size 1 1 1 size 2 2 2 }"));
  EXPECT_NEAR(model.Bounds().sizes().x(), 2.0, 1e-6);
  // VRML 1.0 and Inventor have no such field that is read; the children of a node are no field.
  const std::string vertices = "VertexProperty { vertex [ 0 0 0, 1 0 0, 0 1 0 ] }";
  const std::string faces = "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] } IndexedFaceSet { "
                            "vertexProperty DEF A " +
                            vertices + " vertexProperty " + vertices +
                            " coordIndex [ 0 1 2 -1 ] }\nIndexedFaceSet { vertexProperty USE A "
                            "coordIndex [ 0 1 2 -1 ] }";
  for (const std::string& head : {Head1, std::string("#Inventor V2.1 ascii\n")}) {
    const std::string text = head + "Separator { " + faces + " DEF B Cube { } USE B }";
    for (const std::string& bytes : {text, Gzip(text)}) {
      const Model old = Read(folder, bytes);
      EXPECT_EQ(old.TriangleCount(), 26u);
      EXPECT_TRUE(HasWarning(old.warnings, "unknown field 'vertexProperty'"));
    }
  }
}

TEST(ImportVrml, CirclesAndBombsAreRejectedBeforeParsing) {
  const TempFolder folder;
  const auto bad = [&folder](Error::Kind kind, const std::string& part, const std::string& text) {
    ExpectReadError(kind, part, folder.Write("bad.wrl", text));
  };
  bad(Error::Kind::Corrupt, "'A' is used inside itself",
      Head2 + "DEF A Group { children Group { children USE A } }");
  bad(Error::Kind::Corrupt, "'A' is used inside itself", Head1 + "DEF A Separator { USE A }");
  // Ten thousand levels of braces; a chain of USE as deep; thirty doublings by USE and by PROTO.
  std::string braces = Head2;
  for (int i = 0; i < 10000; ++i) {
    braces += "Group { children ";
  }
  bad(Error::Kind::Resource, "nested deeper than 256", braces);
  std::string chain = Head2 + "DEF N0 Group { }\n";
  std::string uses = Head2 + "DEF N0 Group { children " + Shape("Box { }") + "}\n";
  std::string protos = Head2 + "PROTO N0 [ ] { " + Shape("Box { }") + "}\n";
  std::string fields = Head2 + "PROTO N0 [ field MFNode x [ ] ] { Group { children IS x } }\n";
  for (int i = 1; i < 400; ++i) {
    const std::string n = std::to_string(i);
    const std::string b = std::to_string(i - 1);
    chain += "DEF N" + n + " Group { children USE N" + b + " }\n";
    uses += "DEF N" + n + " Group { children [ USE N" + b + " USE N" + b + " ] }\n";
    protos += "PROTO N" + n + " [ ] { Group { children [ N" + b + " { } N" + b + " { } ] } }\n";
    fields += "PROTO N" + n + " [ field MFNode x [ ] ] { Group { children [ N" + b +
              " { x IS x } N" + b + " { x IS x } ] } }\n";
  }
  bad(Error::Kind::Resource, "nested deeper than 256", chain);
  bad(Error::Kind::Resource, "multiply its nodes beyond", uses);
  bad(Error::Kind::Resource, "multiply its nodes beyond", protos);
  bad(Error::Kind::Resource, "", fields + "N399 { x " + Shape("Box { }") + "}");
  // The default of an image field may be unusable.
  const Model image = Read(folder, Head2 + "PROTO P [ field SFImage i 9 9 3 1 ] { Shape { geometry "
                                           "Box { } appearance Appearance { texture PixelTexture { "
                                           "image IS i } } } } P { }");
  EXPECT_TRUE(HasWarning(image.warnings, "9 x 9 x 3 that has 1 pixels"));
  bad(Error::Kind::Corrupt, "not a type of a field", Head2 + "PROTO P [ field SFEnum e A ] { }");
  // A PROTO inside its own body is no node at that place.
  const Model own =
      Read(folder, Head2 + "PROTO P [ ] { Group { children [ P { } ] } } P { }" + Shape("Box { }"));
  EXPECT_TRUE(HasWarning(own.warnings, "unknown node P"));
  ImportOptions few;
  few.maximumTriangles = 100;
  ExpectReadError(Error::Kind::Resource, "more than 100 triangles",
                  folder.Write("many.wrl", Head2 + "DEF B " + Shape("Box { }") +
                                               "USE B USE B USE B USE B USE B USE B USE B USE B"),
                  few);
}

TEST(ImportVrml, UnknownThingsAreLeftOutWithAWarning) {
  const TempFolder folder;
  const Model model = Read(folder, Head2 + R"(
    Transform { metadata MetadataString { value "x" } extra 1 2 3 other USE Nothing
                children [ NurbsSurface { order 3 } USE Nowhere )" +
                                       Shape("Box { hasHole TRUE size 1 1 1 }") + R"(] }
    DEF T TimeSensor { loop TRUE } ROUTE T.time TO U.value
    Script { url "javascript: function f() { }" eventIn SFTime x field SFNode y Group { } }
)");
  EXPECT_EQ(model.TriangleCount(), 12u);
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(0.5, 0.5, 0.5));
  for (const char* what :
       {"unknown field 'metadata' of Transform", "unknown field 'extra'",
        "unknown node NurbsSurface", "unknown name 'Nowhere'", "unknown field 'hasHole' of Box"}) {
    EXPECT_TRUE(HasWarning(model.warnings, what)) << what;
  }
}

TEST(ImportVrml, ManyWarningsOfAKindAreOne) {
  const TempFolder folder;
  const auto read = [&folder](int textures) {
    std::string text = Head2;
    for (int i = 0; i < textures; ++i) {
      const std::string name = "t" + std::to_string(i) + ".png";
      text += Shape(Triangle(),
                    "appearance Appearance { texture ImageTexture { url \"" + name + "\" } }");
    }
    text += "Inline { url \"nowhere.wrl\" }";
    return Read(folder, text).warnings;
  };
  const std::vector<std::string> few = read(3);
  ASSERT_EQ(few.size(), 4u);
  EXPECT_TRUE(HasWarning(few, "texture 't2.png' is left out: "));
  const std::vector<std::string> many = read(4);
  ASSERT_EQ(many.size(), 2u);
  EXPECT_EQ(many[0].find("4 textures are left out: 't0.png', 't1.png', 't2.png', ..."), 0u)
      << many[0];
  EXPECT_NE(many[0].find("t0.png': does not exist"), std::string::npos) << many[0];
  EXPECT_NE(many[1].find("Inline of 'nowhere.wrl' is left out"), std::string::npos) << many[1];
  // Shapes whose flaws differ in numbers only.
  std::string shapes = Head2;
  for (int i = 0; i < 5; ++i) {
    std::string bad;
    for (int k = 0; k <= i; ++k) {
      bad += "0 1 " + std::to_string(7 + k) + " -1 ";
    }
    shapes += "DEF S" + std::to_string(i) + " " +
              Shape("IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } "
                    "coordIndex [ 0 1 2 -1 " +
                    bad + "] }");
  }
  const std::vector<std::string> flaws = Read(folder, shapes).warnings;
  ASSERT_EQ(flaws.size(), 1u);
  EXPECT_EQ(flaws[0].find("5 shapes: N faces with an index out of range of N points"), 0u)
      << flaws[0];
  EXPECT_NE(flaws[0].find("shape 'S2', ..."), std::string::npos) << flaws[0];
}

} // namespace
} // namespace dspace::testing
