// The registry of drawers: exact classes, replacement, and unknown classes.
#include <dspace/render/CustomDrawers.h>

#include <memory>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/GraphicsObject.h>

using namespace dspace;

namespace {

class Hill : public CustomGeometry {
public:
  BoundingSphere Bounds() const override { return {}; }
  std::uint64_t Revision() const override { return 1; }
};

class SteepHill : public Hill {};

class NumberedDrawer : public CustomDrawer {
public:
  NumberedDrawer(int number, std::shared_ptr<const CustomGeometry> geometry)
      : Number(number), Geometry(std::move(geometry)) {}
  bool Prepare(const CustomDrawing&) override { return true; }
  void DrawColor(const CustomDrawing&) override {}
  void DrawLabels(const CustomDrawing&) override {}
  int Number;
  std::shared_ptr<const CustomGeometry> Geometry;
};

CustomDrawers::Maker Numbered(int number) {
  return [number](std::shared_ptr<const CustomGeometry> geometry) {
    return std::make_unique<NumberedDrawer>(number, std::move(geometry));
  };
}

int NumberOf(const CustomDrawers& drawers, const std::shared_ptr<const CustomGeometry>& geometry) {
  const std::unique_ptr<CustomDrawer> drawer = drawers.Make(geometry);
  const auto& numbered = dynamic_cast<const NumberedDrawer&>(*drawer);
  EXPECT_EQ(numbered.Geometry, geometry);
  return numbered.Number;
}

} // namespace

TEST(CustomDrawers, MakesTheDrawerOfTheExactClass) {
  CustomDrawers drawers;
  drawers.Register(typeid(Hill), Numbered(1));
  drawers.Register(typeid(SteepHill), Numbered(2));
  EXPECT_EQ(NumberOf(drawers, std::make_shared<Hill>()), 1);
  EXPECT_EQ(NumberOf(drawers, std::make_shared<SteepHill>()), 2);
  drawers.Register(typeid(Hill), Numbered(3));
  EXPECT_EQ(NumberOf(drawers, std::make_shared<Hill>()), 3);
}

TEST(CustomDrawers, RejectsAClassWithoutADrawer) {
  CustomDrawers drawers;
  drawers.Register(typeid(Hill), Numbered(1));
  try {
    drawers.Make(std::make_shared<SteepHill>());
    ADD_FAILURE() << "accepted a derived class";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Unsupported);
    EXPECT_NE(std::string(error.what()).find("SteepHill"), std::string::npos) << error.what();
  }
}
