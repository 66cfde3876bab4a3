// Lines of sight by rays and by pictures share no answer: each is found while the other one's
// source is replaced.
#include <limits>

#include <dspace/state/Pictures.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

// Pictures in which every pixel is as far away.
class EvenPictures : public session::Pictures {
public:
  explicit EvenPictures(float range) : Range_(range) {}
  std::unique_ptr<session::PictureSeries> Begin(const std::shared_ptr<Scene>&, int width,
                                                int height, const std::set<std::string>&) override {
    class Series : public session::PictureSeries {
    public:
      explicit Series(session::Picture picture) : Picture_(std::move(picture)) {}
      session::Picture Take(const Projection&, const Pose&) override { return this->Picture_; }

    private:
      session::Picture Picture_;
    };
    session::Picture picture{width, height, {}, {}};
    picture.range.assign(std::size_t(width) * std::size_t(height), this->Range_);
    picture.label.assign(picture.range.size(), 0);
    return std::make_unique<Series>(picture);
  }

private:
  float Range_;
};

class MethodsApart : public CommandTest {
protected:
  // A plain of 101 x 101 posts, 1 m apart, with or without a post of 0.5 m in its middle.
  void Open(bool post) {
    const std::string path = (this->Folder_.Path() / (post ? "post.asc" : "flat.asc")).string();
    std::ofstream file(path);
    file << "ncols 101\nnrows 101\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    for (int i = 0; i < 101 * 101; ++i) {
      file << (post && i == 50 * 101 + 50 ? 0.5 : 0.0) << " ";
    }
    file.close();
    v1::Command command;
    command.mutable_open_terrain()->set_path(path);
    command.mutable_open_terrain()->set_name("plain");
    this->Accept(command);
  }
  // Between places 0.4 m above the ground, 20 m to both sides of the middle.
  v1::LineOfSightReply::Sight Line(v1::Measuring::Method method) {
    v1::Command command;
    v1::LineOfSight& line = *command.mutable_line_of_sight();
    line.mutable_measuring()->set_method(method);
    v1::LineOfSight::Pair& pair = *line.add_pair();
    for (v1::Site* site : {pair.mutable_from_site(), pair.mutable_to_site()}) {
      site->set_terrain("plain");
      site->set_map_x(site == pair.mutable_from_site() ? 30.5 : 70.5);
      site->set_map_y(50.5);
      site->set_height(0.4);
    }
    return this->Accept(command).line_of_sight().sight(0);
  }
  void See(float range) {
    this->Interpreter_.GetState().pictures = std::make_shared<EvenPictures>(range);
  }

  TemporaryFolder Folder_;
};

TEST_F(MethodsApart, RaysFindThePostThatPicturesDoNotShow) {
  this->Open(true);
  EXPECT_FALSE(this->Line(v1::Measuring::EXACT).clear()); // without pictures
  this->See(std::numeric_limits<float>::infinity());
  const v1::LineOfSightReply::Sight both = this->Line(v1::Measuring::BOTH);
  EXPECT_FALSE(both.clear());
  EXPECT_TRUE(both.image_clear());
  EXPECT_NEAR(both.distance(), 19.8, 1e-3); // 0.8 of the way up the triangles of 1 m
}

TEST_F(MethodsApart, PicturesFindThePostThatIsNotThereForRays) {
  this->Open(false);
  this->See(19.8f);
  const v1::LineOfSightReply::Sight both = this->Line(v1::Measuring::BOTH);
  EXPECT_TRUE(both.clear());
  EXPECT_FALSE(both.image_clear());
  const v1::LineOfSightReply::Sight image = this->Line(v1::Measuring::IMAGE);
  EXPECT_FALSE(image.clear());
  EXPECT_NEAR(image.distance(), 19.8, 1e-5);
  EXPECT_NEAR(image.point().z(), 0.4, 1e-5);
  this->See(40.0f); // as far as the end
  EXPECT_TRUE(this->Line(v1::Measuring::BOTH).image_clear());
}

} // namespace
} // namespace dspace::testing
