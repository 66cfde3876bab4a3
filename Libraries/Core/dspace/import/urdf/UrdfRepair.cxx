#include <dspace/import/urdf/UrdfRepair.h>

#include <initializer_list>
#include <locale>
#include <set>
#include <sstream>
#include <vector>

#include <tinyxml.h>

namespace dspace {

namespace {

std::string Quoted(const std::string& kind, const char* name) {
  return kind + " '" + (name ? name : "") + "'";
}

// Whether the text is `n` finite numbers and nothing else.
bool AreNumbers(const char* text, int n) {
  if (!text) {
    return false;
  }
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = 0.0;
  for (int i = 0; i < n; ++i) {
    if (!(in >> value)) {
      return false;
    }
  }
  return (in >> std::ws).eof();
}

// The child elements of that name.
std::vector<TiXmlElement*> Children(TiXmlElement& parent, const char* name) {
  std::vector<TiXmlElement*> found;
  for (TiXmlElement* child = parent.FirstChildElement(name); child;
       child = child->NextSiblingElement(name)) {
    found.push_back(child);
  }
  return found;
}

void RemoveChildren(TiXmlElement& parent, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    for (TiXmlElement* child : Children(parent, name)) {
      parent.RemoveChild(child);
    }
  }
}

class Repairer {
public:
  Repairer(TiXmlElement& robot, GroupedWarnings& warnings) : Robot_(robot), Warnings_(warnings) {}

  void Run() {
    if (!this->Robot_.Attribute("name")) {
      this->Robot_.SetAttribute("name", "");
    }
    this->Robot_.RemoveAttribute("version");
    for (TiXmlElement* material : Children(this->Robot_, "material")) {
      this->RepairMaterial(*material);
    }
    std::vector<TiXmlElement*> visuals;
    for (TiXmlElement* link : Children(this->Robot_, "link")) {
      if (link->Attribute("name") && !this->Links_.insert(link->Attribute("name")).second) {
        this->Warnings_.Add("links are defined twice, the first is taken",
                            Quoted("link", link->Attribute("name")));
        this->Robot_.RemoveChild(link);
        continue;
      }
      RemoveChildren(*link, {"inertial", "collision"});
      const std::string where = Quoted("link", link->Attribute("name"));
      for (TiXmlElement* visual : Children(*link, "visual")) {
        if (this->KeepsVisual(*visual, where)) {
          visuals.push_back(visual);
        } else {
          link->RemoveChild(visual);
        }
      }
    }
    // A material of a visual is known in the whole file.
    for (TiXmlElement* visual : visuals) {
      this->RepairUse(*visual);
    }
    for (TiXmlElement* joint : Children(this->Robot_, "joint")) {
      this->RepairJoint(*joint);
    }
  }

private:
  static bool IsDefinition(const TiXmlElement& material) {
    const TiXmlElement* color = material.FirstChildElement("color");
    const TiXmlElement* texture = material.FirstChildElement("texture");
    return (color && AreNumbers(color->Attribute("rgba"), 4)) ||
           (texture && texture->Attribute("filename"));
  }

  // Of the robot.
  void RepairMaterial(TiXmlElement& material) {
    const char* name = material.Attribute("name");
    const std::string where = Quoted("material", name);
    if (!name || !IsDefinition(material)) {
      this->Warnings_.Add("materials without a name, colour and texture are left out", where);
      this->Robot_.RemoveChild(&material);
    } else if (!this->Materials_.insert(name).second) {
      this->Warnings_.Add("materials are defined twice, the first is taken", where);
      this->Robot_.RemoveChild(&material);
    }
  }

  bool KeepsVisual(TiXmlElement& visual, const std::string& where) {
    TiXmlElement* geometry = visual.FirstChildElement("geometry");
    TiXmlElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
    if (!shape) {
      this->Warnings_.Add("visuals without a shape are left out", where);
      return false;
    }
    const std::string type = shape->ValueStr();
    const auto numbers = [shape](const char* name, int n) {
      return AreNumbers(shape->Attribute(name), n);
    };
    const bool read = type == "sphere"     ? numbers("radius", 1)
                      : type == "box"      ? numbers("size", 3)
                      : type == "cylinder" ? numbers("radius", 1) && numbers("length", 1)
                      : type == "mesh"     ? shape->Attribute("filename") != nullptr
                                           : false;
    if (!read) {
      this->Warnings_.Add(
          "visuals of an unknown shape, or with sizes that are no numbers, are left out",
          where + " (" + type + ")");
      return false;
    }
    if (type == "mesh" && shape->Attribute("scale") && !numbers("scale", 3)) {
      this->Warnings_.Add("scales of meshes that are not three numbers are taken as 1", where);
      shape->RemoveAttribute("scale");
    }
    this->RepairOrigin(visual, where);
    TiXmlElement* material = visual.FirstChildElement("material");
    if (material && !material->Attribute("name")) {
      material->SetAttribute("name", "");
    }
    if (material && IsDefinition(*material)) {
      this->Materials_.insert(material->Attribute("name"));
    }
    return true;
  }

  void RepairUse(TiXmlElement& visual) {
    TiXmlElement* material = visual.FirstChildElement("material");
    if (material && !IsDefinition(*material) &&
        this->Materials_.count(material->Attribute("name")) == 0) {
      this->Warnings_.Add("materials are not defined, their visuals are grey",
                          Quoted("material", material->Attribute("name")));
      visual.RemoveChild(material);
    }
  }

  void RepairOrigin(TiXmlElement& parent, const std::string& where) {
    if (TiXmlElement* origin = parent.FirstChildElement("origin")) {
      for (const char* name : {"xyz", "rpy"}) {
        if (origin->Attribute(name) && !AreNumbers(origin->Attribute(name), 3)) {
          this->Warnings_.Add("origins that are not three numbers are taken as 0", where);
          origin->RemoveAttribute(name);
        }
      }
    }
  }

  void RepairJoint(TiXmlElement& joint) {
    RemoveChildren(joint, {"safety_controller", "calibration", "dynamics"});
    const std::string given = joint.Attribute("name") ? joint.Attribute("name") : "";
    std::string name = given.empty() ? "joint" : given;
    for (int n = 2; !this->Joints_.insert(name).second; ++n) {
      name = (given.empty() ? "joint" : given) + "_" + std::to_string(n);
    }
    const std::string where = Quoted("joint", name.c_str());
    if (name != given) {
      this->Warnings_.Add("joints without a name of their own get one", where);
      joint.SetAttribute("name", name);
    }
    static const std::set<std::string> types = {"planar",     "floating",  "revolute",
                                                "continuous", "prismatic", "fixed"};
    const std::string type = joint.Attribute("type") ? joint.Attribute("type") : "";
    if (types.count(type) == 0) {
      this->Warnings_.Add("joints of an unknown type are taken as floating",
                          where + " (" + type + ")");
      joint.SetAttribute("type", "floating");
    }
    for (const char* end : {"parent", "child"}) {
      const TiXmlElement* element = joint.FirstChildElement(end);
      const char* link = element ? element->Attribute("link") : nullptr;
      // A file without any link is none of a robot.
      if (link && !this->Links_.empty() && this->Links_.insert(link).second) {
        this->Warnings_.Add("joints name links that the file lacks, empty ones are made",
                            where + " (" + link + ")");
        TiXmlElement made("link");
        made.SetAttribute("name", link);
        this->Robot_.InsertEndChild(made);
      }
    }
    this->RepairOrigin(joint, where);
    this->RepairAxis(joint, where);
    this->RepairLimit(joint, where, type == "revolute" || type == "prismatic");
    this->RepairMimic(joint, where);
  }

  void RepairAxis(TiXmlElement& joint, const std::string& where) {
    TiXmlElement* axis = joint.FirstChildElement("axis");
    if (axis && !AreNumbers(axis->Attribute("xyz"), 3)) {
      this->Warnings_.Add("axes that are not three numbers are taken as X", where);
      joint.RemoveChild(axis);
    }
  }

  void RepairLimit(TiXmlElement& joint, const std::string& where, bool limited) {
    TiXmlElement* limit = joint.FirstChildElement("limit");
    if (!limit) {
      if (limited) {
        this->Warnings_.Add("joints without limits take any position", where);
        AddBoundless(joint);
      }
      return;
    }
    for (const char* unused : {"effort", "velocity"}) {
      limit->SetAttribute(unused, "0");
    }
    for (const char* name : {"lower", "upper"}) {
      if (limit->Attribute(name) && !AreNumbers(limit->Attribute(name), 1)) {
        this->Warnings_.Add("limits that are no numbers are left out", where);
        joint.RemoveChild(limit);
        AddBoundless(joint);
        return;
      }
    }
  }

  // As generators write it: the reader takes such limits as none.
  static void AddBoundless(TiXmlElement& joint) {
    TiXmlElement made("limit");
    made.SetAttribute("lower", "-1.7e308");
    made.SetAttribute("upper", "1.7e308");
    made.SetAttribute("effort", "0");
    made.SetAttribute("velocity", "0");
    joint.InsertEndChild(made);
  }

  void RepairMimic(TiXmlElement& joint, const std::string& where) {
    TiXmlElement* mimic = joint.FirstChildElement("mimic");
    if (!mimic) {
      return;
    }
    bool sound = mimic->Attribute("joint") != nullptr;
    for (const char* name : {"multiplier", "offset"}) {
      sound = sound && (!mimic->Attribute(name) || AreNumbers(mimic->Attribute(name), 1));
    }
    if (!sound) {
      this->Warnings_.Add("mimic elements that cannot be read are left out", where);
      joint.RemoveChild(mimic);
    }
  }

  TiXmlElement& Robot_;
  GroupedWarnings& Warnings_;
  std::set<std::string> Materials_;
  std::set<std::string> Links_;
  std::set<std::string> Joints_;
};

} // namespace

std::string RepairUrdfText(const std::string& text, GroupedWarnings& warnings) {
  TiXmlDocument document;
  document.Parse(text.c_str());
  TiXmlElement* robot = document.FirstChildElement("robot");
  if (!robot || document.Error()) { // a file that is cut short has lost links
    return text;
  }
  Repairer(*robot, warnings).Run();
  TiXmlPrinter printer;
  document.Accept(&printer);
  return printer.Str();
}

} // namespace dspace
