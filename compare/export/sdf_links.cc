// Prints the links of a world as libsdformat reads it, for check_export.py: model, mass, centre and inertia of each link
// in its model's frame. Errors go to stderr and fail.
#include <iostream>

#include <sdf/sdf.hh>

int main(int count, char **arguments) {
  if (count != 2) {
    std::cerr << "usage: sdf_links FILE\n";
    return 2;
  }
  sdf::Root root;
  const sdf::Errors errors = root.Load(arguments[1]);
  for (const auto &error : errors) std::cerr << error << "\n";
  const sdf::World *world = root.WorldByIndex(0);
  if (!errors.empty() || !world) return 1;
  std::cout.precision(17);
  for (uint64_t m = 0; m < world->ModelCount(); m++) {
    const sdf::Model *model = world->ModelByIndex(m);
    if (model->Static()) continue;
    for (uint64_t l = 0; l < model->LinkCount(); l++) {
      const sdf::Link *link = model->LinkByIndex(l);
      const auto &inertial = link->Inertial();
      if (!inertial.MassMatrix().IsValid()) {
        std::cerr << link->Name() << ": not the inertia of a solid\n";
        return 1;
      }
      const auto centre = link->RawPose() * inertial.Pose();
      // one by one: the library prints vectors and matrices with six decimals only
      std::cout << model->Name() << " " << inertial.MassMatrix().Mass();
      for (int k = 0; k < 3; k++) std::cout << " " << centre.Pos()[k];
      const auto moi = inertial.Moi();
      for (int k = 0; k < 9; k++) std::cout << " " << moi(k / 3, k % 3);
      std::cout << " " << link->CollisionCount() << "\n";
    }
  }
}
