"""What a session tells a renderer of another program: the driver's view as models, frames and readings."""

from collections.abc import Sequence

from simconsole.bridge.console.view_topics import ExternalView, Model, MovingFrame
from simconsole.hud.driver_view.models import BASE, MAP, moving_frames, vehicle_model, world_model
from simconsole.hud.driver_view.motion import shown_vehicle
from simconsole.hud.driver_view.vehicle_body import vehicle_meshes
from simconsole.hud.guidance import guidance_of
from simconsole.hud.reading import HudReading
from simconsole.hud.view import HudSettings, settings_of
from simconsole.profiles.view import ENGLISH, HudProfile
from simconsole.session.view.view_job import ViewJob, limit_kmh
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world


def external_view(job: ViewJob, settings: HudSettings) -> ExternalView:
    """Return the view of a drive; its models take a second of work where there is a town. Its words are English.

    Args:
        job: What there is to see.
        settings: What the driver's display must know of the drive.
    """
    meshes = vehicle_meshes(job.size)

    def frames(snapshot: Snapshot) -> Sequence[MovingFrame]:
        return moving_frames(meshes, job.steering_ratio, shown_vehicle(snapshot))

    return ExternalView(
        models=(
            Model(MAP, "world.glb", world_model(job.drawing, job.limits, job.models.world)),
            Model(BASE, "vehicle.glb", vehicle_model(job.size, job.models.body)),
        ),
        frames=frames,
        reading=HudReading(settings._replace(language=ENGLISH)),
    )


def display_settings(resolved: ResolvedSession) -> HudSettings:
    """Return what any driver's display must know of a session."""
    session = resolved.session
    settings = settings_of(
        session.outputs.hud or HudProfile(),
        session.features.control,
        resolved.cockpit,
        resolved.vehicle,
        by_keyboard=session.devices.driver == "keyboard",
        language=resolved.language,
    )
    if resolved.world is None or settings.is_robot:  # robots follow no road
        return settings
    route = open_world(resolved.world).route
    return settings._replace(limit_kmh=limit_kmh(route), guidance=guidance_of(route))
