#include <APIHeaderSection_MakeHeader.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message_ProgressIndicator.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TCollection_HAsciiString.hxx>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "solid/brep.hpp"
#include "solid/inspection.hpp"
#include "solid/step_file.hpp"

namespace krepl::solid {

namespace {

Handle(TCollection_HAsciiString) text(const std::string& s) { return new TCollection_HAsciiString(s.c_str()); }

Error cancelled() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

/// Lets OpenCASCADE ask whether to go on.
class Asking : public Message_ProgressIndicator {
 public:
  explicit Asking(const Context& context) : context_(context) {}
  Standard_Boolean UserBreak() override { return context_.cancelled(); }

 protected:
  void Show(const Message_ProgressScope&, const Standard_Boolean) override {
    if (context_.progress) context_.progress(0.5 + 0.4 * GetPosition());
  }

 private:
  const Context& context_;
};

/// Numbers have thirteen digits: with more OpenCASCADE loses their exponents. A full disk is told by the stream.
bool put(const std::string& path, const Handle(StepData_StepModel) & model) {
  StepData_StepWriter writer(model);
  writer.SendModel(Handle(StepData_Protocol)::DownCast(model->Protocol()));
  std::ofstream file(path, std::ios::binary);
  const bool printed = writer.Print(file);
  file.close();
  return printed && file.good();
}

/// OpenCASCADE counts the products of a run in their names.
void name_product(const Handle(StepData_StepModel) & model, const std::string& name) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(StepBasic_Product) product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (product.IsNull()) continue;
    product->SetName(text(name));
    product->SetId(text(name));
  }
}

Status write_file(const std::string& path, const TopoDS_Shape& shape, const StepOptions& options,
                  const Context& context) {
  STEPControl_Controller::Init();
  const char* unit = unit_name(options.unit);
  Interface_Static::SetCVal("xstep.cascade.unit", unit);
  Interface_Static::SetCVal("write.step.unit", unit);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  // Curves in the parameters of surfaces double the file, and readers make their own.
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
  STEPControl_Writer writer;
  const Handle(Asking) asking = new Asking(context);
  const IFSelect_ReturnStatus transferred = writer.Transfer(shape, STEPControl_AsIs, true, asking->Start());
  if (context.cancelled()) return cancelled();
  if (transferred != IFSelect_RetDone)
    return Error{ErrorCode::computation, "OpenCASCADE cannot turn the surface into STEP", "", ""};
  const Handle(StepData_StepModel) model = writer.Model();
  name_product(model, options.name);
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text(options.name));
  header.SetTimeStamp(text(options.date));
  header.SetAuthorValue(1, text(""));
  header.SetOrganizationValue(1, text(""));
  header.SetOriginatingSystem(text("krepl"));
  header.SetAuthorisation(text(""));
  header.Apply(model);
  if (put(path, model)) return std::monostate{};
  return Error{ErrorCode::io, "cannot be written", "", "free some space or choose another place"};
}

/// What is smaller is left out, in terms of the radius: first as much as keeps everything within a millionth, then
/// more.
constexpr double relative_tolerances[] = {5e-7, 5e-6, 5e-5};
constexpr double relative_curve_tolerance = 5e-8;
/// OpenCASCADE takes points closer than 1e-7 of its unit for one.
constexpr double resolution = 2e-7;

/// STEP has no tolerances of corners: readers widen them where edges leave a corner in one direction, and only then is
/// the solid sound. So if the checker objects to the solid as it is made, the file decides.
Status check(const std::string& path, const Brep& brep, const StepOptions& options, const Context& context) {
  if (!fault_of(brep.shape)) return std::monostate{};
  if (context.cancelled()) return cancelled();
  const Result<TopoDS_Shape> shape = read_step(path, options.unit);
  if (!shape) return shape.error();
  const Inspection made = inspect(brep.shape), read = inspect(*shape);
  constexpr double accuracy = 1e-6;
  if (!read.fault && made.faces == read.faces && std::fabs(made.area - read.area) <= accuracy * made.area)
    return std::monostate{};
  const Point3 p = read.fault ? *read.fault : made.fault.value_or(Point3{});
  return Error{ErrorCode::computation, "OpenCASCADE's checker rejects the solid",
               "near " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z),
               "take a slightly different radius"};
}

StepReport report_of(const BrepCounts& counts, double tolerance) {
  StepReport report;
  report.planes = counts.planes, report.cylinders = counts.cylinders, report.spheres = counts.spheres;
  report.walls = counts.walls, report.floors = counts.floors, report.narrow_faces = counts.narrow_faces;
  report.edges = counts.edges, report.shells = counts.shells;
  report.tolerance = tolerance, report.deviation = counts.deviation;
  return report;
}

}  // namespace

Result<StepReport> write_step(const std::string& path, const Surface& surface, const StepOptions& options,
                              const Context& context) {
  if (unit_name(options.unit) == nullptr)
    return Error{ErrorCode::usage, "unit '" + options.unit + "' is unknown", "", "give mm, cm, m, km, in or ft"};
  silence();
  Error error;
  for (const double relative : relative_tolerances) {
    const BrepOptions brep_options{options.closed, std::max(resolution, relative * surface.radius()),
                                   relative_curve_tolerance * surface.radius()};
    const Result<Brep> brep = make_brep(surface, brep_options, context);
    if (!brep) return brep.error();
    try {
      if (Status written = write_file(path, brep->shape, options, context); !written) return written.error();
      const Status checked = check(path, *brep, options, context);
      if (checked) return report_of(brep->counts, brep_options.tolerance);
      error = checked.error();
    } catch (const Standard_Failure& failure) {
      error = {ErrorCode::computation, std::string("OpenCASCADE fails: ") + failure.GetMessageString(), "", ""};
    }
    if (context.cancelled()) return cancelled();
  }
  return error;
}

}  // namespace krepl::solid
