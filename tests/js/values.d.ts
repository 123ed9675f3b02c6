/** What the page's comments call the values of the server. The shapes come from `api.d.ts`, which `make` generates. */

import type { components } from "./api";

type Schemas = components["schemas"];

/** A point: of the garment frame, or of the board (m, or px). */
export type Point = [number, number];
export type Point3 = Schemas["Grip"]["pick"];
export type Pose = Schemas["Pose2"];

export type Drawing = Schemas["Drawing"];
export type Corner = Schemas["Corner"];
export type Curve = Schemas["Curve"];
export type Fold = Schemas["Crease"];
export type FoldEnd = Schemas["End"];
export type FoldKind = Fold["kind"];
export type Garment = Schemas["GarmentAnswer"];
export type GarmentEntry = Schemas["GarmentEntry"];
export type RobotEntry = Schemas["RobotEntry"];
export type RobotTaken = Schemas["RobotTaken"];
export type GarmentFold = Schemas["GarmentFold"];
export type Scene = Schemas["Scene"];
export type Table = Schemas["Table"];

export type DocumentState = Schemas["DocumentAnswer"];
export type DocumentEntry = Schemas["DocumentEntry"];
export type DocumentVersion = Schemas["VersionAnswer"];
export type DrawingProblem = Schemas["DrawingProblem"];
export type Step = Schemas["StepAnswer"];
export type Layer = Schemas["MovedLayerAnswer"];
export type Steps = Schemas["StepsAnswer"];
export type Crease = Schemas["CreaseAnswer"];
export type QuickFixes = Schemas["QuickFixesAnswer"];

export type LiveMessage = Schemas["LiveMessage"];
export type Command = Schemas["LiveCommand"];
export type Result = Schemas["Result"];
export type PlanMessage = Schemas["PlanMessage"];
export type Playback = Schemas["PlaybackAnswer"];
export type Plan = Schemas["PlanOnShow"];
export type PlanStart = Schemas["WorldState"];
export type PlanBefore = Schemas["PlanBefore"];
export type StepPicture = Schemas["PictureAnswer"];
export type Primitive = Plan["primitives"][number];
export type Reason = Schemas["ReasonAnswer"];
export type Statistics = Schemas["Statistics"];

export type Overlays = Schemas["OverlaysAnswer"];
export type Region = Schemas["RegionAnswer"];
export type Places = Schemas["PlacesAnswer"];

export type SuggestionEvent = Schemas["SuggestionEvent"];
export type TryingEvent = Schemas["TryingEvent"];
export type PlanChange = Partial<Schemas["Change"]>;

export type Template = Schemas["TemplateAnswer"];
export type Measure = Schemas["MeasureAnswer"];
export type Made = Schemas["MadeAnswer"];
export type FileEntry = Schemas["FileEntry"];
export type Imported = Schemas["ImportAnswer"];
export type Job = Schemas["JobEntry"];
export type Trace = Schemas["TraceAnswer"];
export type TraceStep = Trace["steps"][number];
export type Look = Trace["pictures"][number];
export type Problem = Schemas["Problem"];

/** A message as data. Which numbers it has follows from its code, so each of its words says what it reads. */
export type Says = { code: string; [name: string]: any };
