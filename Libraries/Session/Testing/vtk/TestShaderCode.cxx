// Shader code written for vtkActors gives the same pixels on Dspace's objects; invalid code is
// rejected.
#include "PlainWindow.h"

#include <functional>

#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkDspaceActors.h"
#include "vtkDspaceScene.h"
#include "vtkShaderProperty.h"
#include "vtkUniforms.h"

namespace dspace::testing {
namespace {

class ShaderCodeTest : public PlainWindowTest {
protected:
  void SetUp() override {
    PlainWindowTest::SetUp();
    this->Run("create_scene {}");
    // VTK has normals only where a light is. The codes make all of the colour ambient, so that the
    // light, which ours computes in linear light, adds nothing.
    this->Run("set_light { name: 'head' kind: HEAD }");
    this->Run("create_frame { id: 10 parent: 1 name: 'base' "
              "pose { position { x: 1 y: 2 z: 3 } rotation { w: 0.8 x: 0.6 } scale: 1.5 } }");
    this->Run("create_primitive { object { id: 1 name: 'ball' frame: 10 "
              "material { color { r: 0.5 g: 0.5 b: 0.5 } metallic: 0 roughness: 1 } } "
              "sphere { radius: 1.2 resolution: 64 } }");
    this->Run("set_camera { name: 'eye' mount { look_at { eye { x: 5 y: -3 z: 5 } "
              "target { x: 1 y: 2 z: 3 } } } }");
    this->MakeView();
    this->Actors_.TakeReference(this->Session_->GetScene("scene")->MakeActors("", 5000));
    this->Actors_->SetCamera("main", "eye");
    this->Actors_->SetRenderer(this->Renderer_);
    this->Actor_ = vtkActor::SafeDownCast(this->Actors_->GetActors()->GetItemAsObject(0));
  }

  // Gives the actor's code to our object.
  v1::Reply SetOurs(vtkShaderProperty* property) {
    EXPECT_EQ(this->Session_->CheckShader(property), "");
    v1::Command command;
    EXPECT_TRUE(
        command.mutable_set_shader()->ParseFromString(this->Session_->SerializeShader(property)));
    command.mutable_set_shader()->set_object(1);
    return this->Execute(command);
  }

  void ExpectSamePixels() {
    const Picture before = this->Ours();
    const v1::Reply reply = this->SetOurs(this->Actor_->GetShaderProperty());
    ASSERT_FALSE(reply.has_error()) << reply.error().message();
    EXPECT_EQ(reply.warning_size(), 0) << reply.warning(0);
    const Picture ours = this->Ours();
    EXPECT_NE(ours.color, before.color);
    const Picture plain = this->Plain();
    EXPECT_GT(Compare(ours, plain, 2), 3000);
    // The label plane has the shape that VTK draws, but for its edge.
    int different = 0;
    for (std::size_t i = 0; i < ours.label.size(); ++i) {
      const bool drawn = plain.color[4 * i] || plain.color[4 * i + 1] || plain.color[4 * i + 2];
      different += drawn != (ours.label[i] != 0);
    }
    EXPECT_LT(different, 60);
  }

  vtkSmartPointer<vtkDspaceActors> Actors_;
  vtkActor* Actor_ = nullptr;
};

// In spirit VTK's TestUserShader: the normal in model coordinates as the colour.
TEST_F(ShaderCodeTest, ColorsByTheNormal) {
  vtkShaderProperty* code = this->Actor_->GetShaderProperty();
  code->AddVertexShaderReplacement("//VTK::Normal::Dec", true,
                                   "//VTK::Normal::Dec\n  out vec3 myNormalMCVSOutput;\n", false);
  code->AddVertexShaderReplacement("//VTK::Normal::Impl", true,
                                   "//VTK::Normal::Impl\n  myNormalMCVSOutput = normalMC;\n",
                                   false);
  code->AddFragmentShaderReplacement("//VTK::Normal::Dec", true,
                                     "//VTK::Normal::Dec\n  in vec3 myNormalMCVSOutput;\n", false);
  code->AddFragmentShaderReplacement(
      "//VTK::Normal::Impl", true,
      "//VTK::Normal::Impl\n  ambientColor = 0.5 + 0.25 * abs(myNormalMCVSOutput)"
      " + 0.25 * normalVCVSOutput;\n  diffuseColor = vec3(0.0);\n",
      false);
  this->ExpectSamePixels();
}

TEST_F(ShaderCodeTest, MovesVertices) {
  vtkShaderProperty* code = this->Actor_->GetShaderProperty();
  code->AddVertexShaderReplacement(
      "//VTK::PositionVC::Impl", true,
      "  vec4 moved = vec4(vertexMC.xyz * (1.0 + 0.25 * sin(6.0 * vertexMC.z)), 1.0);\n"
      "  vertexVCVSOutput = MCVCMatrix * moved;\n"
      "  gl_Position = MCDCMatrix * moved;\n",
      false);
  code->AddFragmentShaderReplacement("//VTK::Light::Impl", true,
                                     "  gl_FragData[0] = vec4(0.4 + 0.1 * vertexVC.xy, 0.3, 1.0);\n"
                                     "  //VTK::Light::Done\n",
                                     false);
  const Picture round = this->Ours();
  this->ExpectSamePixels();
  const Picture waved = this->Ours();
  EXPECT_NE(round.label, waved.label); // not a picture of the sphere
}

TEST_F(ShaderCodeTest, TintsByUniforms) {
  vtkShaderProperty* code = this->Actor_->GetShaderProperty();
  const float tint[3] = {0.9f, 0.4f, 0.2f};
  code->GetFragmentCustomUniforms()->SetUniform3f("tint", tint);
  code->GetFragmentCustomUniforms()->SetUniformf("phase", 3.5f);
  code->GetFragmentCustomUniforms()->SetUniformi("bands", 2);
  float turn[9] = {0, 1, 0, 0, 0, 1, 1, 0, 0}; // not symmetric
  code->GetFragmentCustomUniforms()->SetUniformMatrix3x3("turn", turn);
  const float levels[3] = {0.25f, 0.5f, 1.0f};
  code->GetFragmentCustomUniforms()->SetUniform1fv("levels", 3, levels);
  code->AddFragmentShaderReplacement(
      "//VTK::Color::Impl", true,
      "//VTK::Color::Impl\n  ambientColor = (turn * tint) * (0.75 + 0.25 * sin(phase * float(bands)"
      " * vertexVC.x)) * levels[1] + 0.2;\n  diffuseColor = vec3(0.0);\n",
      false);
  this->ExpectSamePixels();
  code->GetFragmentCustomUniforms()->SetUniformf("phase", 1.0f);
  this->ExpectSamePixels();
}

// Code after the shader's own, and a discard, which reaches the label plane.
TEST_F(ShaderCodeTest, LaterReplacementsAndHoles) {
  vtkShaderProperty* code = this->Actor_->GetShaderProperty();
  code->AddFragmentShaderReplacement("//VTK::Color::Impl", true,
                                     "//VTK::Color::Impl\n  if (vertexVC.x > 0.0) { discard; }\n"
                                     "  diffuseColor = vec3(0.0); ambientColor = vec3(0.3);\n",
                                     false);
  code->AddFragmentShaderReplacement("ambientColor = vec3(0.3);", false,
                                     "ambientColor = vec3(0.2, 0.6, 0.4);", true);
  this->ExpectSamePixels();
}

TEST_F(ShaderCodeTest, RejectedCodeLeavesTheEarlierOne) {
  this->Run("set_shader { object: 1 replacement { stage: FRAGMENT original: '//VTK::Light::Impl' "
            "replacement: '//VTK::Light::Impl\\n fragOutput0.rgb = vec3(1.0, 0.5, 0.0);' } }");
  const Picture before = this->Ours();
  const auto rejected = [&](const std::string& shader, v1::Error::Kind kind,
                            const std::vector<std::string>& words) {
    v1::Command command;
    ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(
        "set_shader { object: 1 " + shader + " }", &command))
        << shader;
    const v1::Reply reply = this->Execute(command);
    EXPECT_EQ(reply.error().kind(), kind) << shader << reply.ShortDebugString();
    for (const std::string& word : words) {
      EXPECT_NE(reply.error().message().find(word), std::string::npos) << reply.error().message();
    }
  };
  using E = v1::Error;
  rejected("replacement { stage: FRAGMENT original: '//VTK::Color::Impl' "
           "replacement: 'nonsense = thing;' }",
           E::INVALID_ARGUMENT, {"object 'ball'", "nonsense = thing;", "nonsense"});
  rejected("replacement { stage: VERTEX original: '//VTK::Normal::Impl' "
           "replacement: 'normalVCVSOutput = 7;' }",
           E::INVALID_ARGUMENT, {"object 'ball'", "vertex"});
  rejected("replacement { original: '' }", E::INVALID_ARGUMENT, {"tag"});
  rejected("uniform { name: '9' value: 1 }", E::INVALID_ARGUMENT, {"'9'"});
  rejected("uniform { name: 'dspaceBase' value: 1 }", E::INVALID_ARGUMENT, {"dspaceBase"});
  rejected("uniform { name: 'a' type: VECTOR3 value: [1, 2] }", E::INVALID_ARGUMENT,
           {"'a'", "2 numbers"});
  rejected("uniform { name: 'a' value: nan }", E::INVALID_ARGUMENT, {"'a'"});
  rejected("uniform { name: 'a' type: INTEGER value: 0.5 }", E::INVALID_ARGUMENT, {"0.5"});
  rejected("uniform { name: 'a' value: 1 } uniform { name: 'a' value: 2 }", E::INVALID_ARGUMENT,
           {"two"});
  rejected("uniform { name: 'a' count: 2000 value: 1 }", E::INVALID_ARGUMENT, {"2000"});
  EXPECT_EQ(this->Ours().color, before.color);

  const v1::Reply unused =
      this->Run("set_shader { object: 1 replacement { original: '//VTK::Nothing' } }");
  ASSERT_EQ(unused.warning_size(), 1);
  EXPECT_NE(unused.warning(0).find("//VTK::Nothing"), std::string::npos);
  this->Run("create_text { object { id: 5 name: 'words' } text: 'words' label {} }");
  v1::Command label;
  google::protobuf::TextFormat::ParseFromString(
      "set_shader { object: 5 replacement { original: '//VTK::Color::Impl' } }", &label);
  EXPECT_EQ(this->Execute(label).error().kind(), E::UNSUPPORTED);
}

TEST_F(ShaderCodeTest, CodeIsDescribedAndRemoved) {
  const Picture before = this->Ours();
  this->Run("set_shader { object: 1 replacement { stage: FRAGMENT original: '//VTK::Light::Impl' "
            "after: true replacement: 'fragOutput0 = vec4(1.0);' first_only: true } "
            "uniform { name: 'a' type: MATRIX3 value: [1, 2, 3, 4, 5, 6, 7, 8, 9] } }");
  const v1::ObjectInfo info = this->Run("describe_object { object: 1 }").object_info();
  ASSERT_EQ(info.shader().replacement_size(), 1);
  EXPECT_TRUE(info.shader().replacement(0).after());
  EXPECT_TRUE(info.shader().replacement(0).first_only());
  EXPECT_EQ(info.shader().uniform(0).value(5), 6.0);
  EXPECT_NE(this->Ours().color, before.color);
  this->Run("set_shader { object: 1 }");
  EXPECT_FALSE(this->Run("describe_object { object: 1 }").object_info().has_shader());
  EXPECT_EQ(this->Ours().color, before.color);
}

TEST_F(ShaderCodeTest, WhatHasNoCounterpartIsRefused) {
  vtkNew<vtkActor> actor;
  vtkShaderProperty* code = actor->GetShaderProperty();
  code->AddGeometryShaderReplacement("//VTK::Color::Impl", true, "x", false);
  EXPECT_NE(this->Session_->CheckShader(code).find("Geometry"), std::string::npos);
  EXPECT_EQ(this->Session_->SerializeShader(code), "");
  code->ClearAllShaderReplacements();
  code->SetFragmentShaderCode("void main() {}");
  EXPECT_NE(this->Session_->CheckShader(code).find("whole shader"), std::string::npos);
  code->SetFragmentShaderCode(nullptr);
  const int pair[2] = {1, 2};
  code->GetVertexCustomUniforms()->SetUniform2i("pair", pair);
  EXPECT_NE(this->Session_->CheckShader(code).find("'pair'"), std::string::npos);
}

} // namespace
} // namespace dspace::testing
